// Gradients of motions with contacts, from text to result, beside the motions themselves.
#pragma once

#include "suites/bench.hpp"

namespace bench {

void contact_gradients(Bench& bench);

}  // namespace bench
