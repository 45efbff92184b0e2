#include "catena/scene/element_filler.hpp"

namespace catena {

template ElementFiller<double> element_filler(int type);

}  // namespace catena
