// Evaluating columns of every kind allocates nothing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "columns/two_bodies.hpp"

namespace {
bool counting = false;
int allocations = 0;
}  // namespace

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
// Algorithms that can do without a buffer ask for it this way; it goes back through the same delete.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  if (counting) ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace catena::testing {
namespace {

TEST(Allocation, EvaluatingColumnsTakesNoMemory) {
  TwoBodies m;
  m.model.add_force("S", SpringDamper<double>{{}, {}, 30, 4, 0.5}, 0, 2);
  m.model.add("L", Translational<double>{{0.1, 0.0}, {0.0, 0.2}, {3.0, 4.0}, {}}, 0, 1);
  m.lambda.clear();
  m.make_plan();
  m.driver_work.assign(m.model.elements.size(), 0.0);
  const std::vector<std::string> names{"t",          "residual",   "crank",    "crank.tip",  "A.reaction", "W.reaction",
                                       "reach.load", "reach.work", "D.value",  "D.rate",     "B.angle",    "L.slide",
                                       "S.force",    "energy",     "momentum", "drive.power"};
  const ColumnSet columns = ColumnSet::resolve(m.model, *m.plan, names, everything);
  std::vector<double> out(columns.size());
  const Snapshot snapshot = m.snapshot();
  allocations = 0;
  counting = true;
  columns.evaluate(snapshot, out);
  counting = false;
  EXPECT_EQ(allocations, 0);
  // The counter counts.
  counting = true;
  std::vector<double> some(10, 1.0);
  counting = false;
  EXPECT_EQ(allocations, 1) << some[0];
}

}  // namespace
}  // namespace catena::testing
