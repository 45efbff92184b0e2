#include "catena/analysis/run/law_switches.hpp"

#include <algorithm>
#include <cmath>

#include "catena/assembly/law_values.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/switches.hpp"

namespace catena {
namespace {

/// What a law reads, in plain numbers.
class ReadState {
 public:
  ReadState(const Evaluator& evaluator, std::span<const double> qd) : evaluator_(evaluator), qd_(qd) {}

  double time() const { return evaluator_.time(); }
  Frame<double> frame(int plan_body) const { return evaluator_.ground_frame(plan_body); }
  Twist<double> twist(int plan_body) const {
    const double* v = &qd_[at(3 * plan_body)];
    return {v[0], v[1], v[2]};
  }
  double function(int number) const { return evaluator_.pose().functions[at(number)].f; }

 private:
  const Evaluator& evaluator_;
  std::span<const double> qd_;
};

/// What is compared in a law there, appended to `differences`.
void read_switches(const Evaluator& evaluator, int law, std::span<const double> qd, std::vector<double>& differences) {
  const ReadState state(evaluator, qd);
  const LawValues<double, double, ReadState> values(evaluator.model(), evaluator.laws(), state);
  const CompiledLaw<double>& compiled = evaluator.laws()[at(law)];
  SwitchNotes<double> notes{.all = &differences};
  note_switches(
      compiled.formula, [&](std::uint32_t k) { return values.input(compiled.inputs[k]); }, notes);
}

/// Whether the parabola through three samples of one sign comes nearer to zero
/// than half of the least of them: what it misses may be the rest.
bool dips(std::span<const double> t, std::span<const double> v) {
  if (!(v[0] * v[1] > 0 && v[1] * v[2] > 0)) return false;
  const double sign = v[1] > 0 ? 1 : -1;
  const double d1 = (v[1] - v[0]) / (t[1] - t[0]), d2 = (v[2] - v[1]) / (t[2] - t[1]);
  const double bend = (d2 - d1) / (t[2] - t[0]);
  const double lowest = (t[0] + t[1]) / 2 - d1 / (2 * bend);
  if (!(sign * bend > 0 && lowest > t[0] && lowest < t[2])) return false;
  const double value = v[0] + (lowest - t[0]) * (d1 + (lowest - t[1]) * bend);
  return 2 * sign * value < std::min({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

}  // namespace

void LawSwitches::begin(const Evaluator& evaluator) {
  evaluator_ = &evaluator;
  laws_.clear();
  const std::vector<double> rest(at(evaluator.plan().coordinates()), 0.0);
  for (int law = 0; law < static_cast<int>(evaluator.laws().size()); ++law) {
    std::vector<double> differences;
    read_switches(evaluator, law, rest, differences);
    if (!differences.empty()) laws_.push_back(law);
  }
}

void LawSwitches::read(std::span<const double> qd, std::vector<double>& differences) const {
  differences.clear();
  for (const int law : laws_) read_switches(*evaluator_, law, qd, differences);
}

bool LawSwitches::may_switch(std::span<const double> t, std::span<const double> v) {
  const auto [least, most] = std::minmax_element(v.begin(), v.end());
  if (*least < 0 && *most > 0) return true;
  for (std::size_t place = 0; place + 2 < v.size(); ++place) {
    if (dips(t.subspan(place, 3), v.subspan(place, 3))) return true;
  }
  return false;
}

}  // namespace catena
