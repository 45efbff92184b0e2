#include "catena/scene/numbers/number_domain.hpp"

#include <fmt/format.h>

namespace catena {

std::string out_of_domain(double value, Domain domain) {
  return fmt::format("must be {}; it is {}", wanted(domain), value);
}

}  // namespace catena
