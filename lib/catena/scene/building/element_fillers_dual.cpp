// The fillers over dual numbers, in a unit of their own: they take as long to compile as those over plain ones.
#include "catena/scene/building/element_filler.hpp"

namespace catena {

template ElementFiller<Dual<double, 4>> element_filler(int type);

}  // namespace catena
