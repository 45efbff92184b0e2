// What gradients cost beside the runs that they belong to, and the gradients of motions beside SUNDIALS.
//
// Times of one problem are taken in one run, and the ratio stands among the counts of the gradient's row: "run, us";
// "runs" of a whole gradient, the run itself included; "runs a parameter" of derivatives carried forward, without it.
#pragma once

#include "suites/bench.hpp"

namespace bench {

void gradient_costs(Bench& bench);

}  // namespace bench
