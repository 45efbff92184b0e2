#include "catena/scene/building/element_filler.hpp"

namespace catena {

template ElementFiller<double> element_filler(int type);

}  // namespace catena
