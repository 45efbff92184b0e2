#include "catena/analysis/kinematics/course/power_samples.hpp"

#include <algorithm>
#include <cmath>

#include "catena/assembly/law_values.hpp"
#include "catena/base/at.hpp"
#include "catena/columns/switches.hpp"

namespace catena {
namespace {

// The places in a stretch of length one: those of WorkSum between its ends.
constexpr std::array<double, PowerSamples::places> place_in_stretch = {
    0, 0.069431844202973712, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629, 1};
// p2 ... p5 there.
constexpr std::array<std::array<double, PowerSamples::places>, 4> polynomials = {{
    {0.418853908291696, 0.134696646659995, -0.553550554951690, -0.553550554951690, 0.134696646659995,
     0.418853908291695},
    {-0.366053325651938, 0.199606046717428, 0.571106285110746, -0.571106285110746, -0.199606046717428,
     0.366053325651938},
    {0.397359707119513, -0.561417978614763, 0.164058271495249, 0.164058271495249, -0.561417978614762,
     0.397359707119513},
    {-0.311085508419128, 0.510399649179225, -0.377780365515913, 0.377780365515913, -0.510399649179225,
     0.311085508419128},
}};

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

/// Whether the parabola through three samples of one sign comes nearer to zero than half of the least of them: what it
/// misses may be the rest.
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

void PowerSamples::begin(const Evaluator& evaluator) {
  evaluator_ = &evaluator;
  laws_.clear();
  const std::vector<double> rest(at(evaluator.plan().coordinates()), 0.0);
  for (int law = 0; law < static_cast<int>(evaluator.laws().size()); ++law) {
    std::vector<double> differences;
    read_switches(evaluator, law, rest, differences);
    if (!differences.empty()) laws_.push_back(law);
  }
}

void PowerSamples::take(std::size_t place, double dissipated, double supplied, std::span<const double> qd) {
  power_[0][place] = dissipated;
  power_[1][place] = supplied;
  differences_[place].clear();
  for (const int law : laws_) read_switches(*evaluator_, law, qd, differences_[place]);
}

double PowerSamples::error(double span) const {
  double largest = 0;
  for (const auto& power : power_) {
    std::array<double, polynomials.size()> c{};
    for (std::size_t k = 0; k < c.size(); ++k) {
      for (std::size_t place = 0; place < places; ++place) c[k] += polynomials[k][place] * power[place];
    }
    const double low = std::hypot(c[0], c[1]), top = std::hypot(c[2], c[3]) / std::sqrt(double{places});
    const double part = std::hypot(c[2], c[3]) / (unresolved * low);
    largest = std::max(largest, std::abs(span) * top * (part < 1 ? part * part : 1));
  }
  return largest;
}

bool PowerSamples::may_switch() const {
  for (std::size_t k = 0; k < differences_[0].size(); ++k) {
    std::array<double, places> v{};
    for (std::size_t place = 0; place < places; ++place) v[place] = differences_[place][k];
    const auto [least, most] = std::minmax_element(v.begin(), v.end());
    if (*least < 0 && *most > 0) return true;
    for (std::size_t place = 0; place + 2 < places; ++place) {
      if (dips(std::span(place_in_stretch).subspan(place, 3), std::span<const double>(v).subspan(place, 3)))
        return true;
    }
  }
  return false;
}

}  // namespace catena
