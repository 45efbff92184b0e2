// What a run by RungeKutta has to say: orders, projections, and passages where branches meet.
#include <fmt/format.h>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

namespace catena {
namespace {

std::string instants_of(const PassageCount& passages) {
  return fmt::format("t = {:.6g} s{}", passages.first,
                     passages.times > 1 ? fmt::format(" and {} times later", passages.times - 1) : "");
}

}  // namespace

std::vector<std::string> RungeKutta::remarks() const {
  std::vector<std::string> all;
  if (order_.low_steps() > 0)
    all.push_back(fmt::format("order 5 took over for {} steps where order 8 failed repeatedly", order_.low_steps()));
  if (projected_steps_ > 0)
    all.push_back(fmt::format("{} steps across nearly singular positions were projected", projected_steps_));
  remark_on_branches(all);
  if (partition_ && partition_->choices() > 1)
    all.push_back(fmt::format("independent coordinates were chosen {} times", partition_->choices()));
  return all;
}

void RungeKutta::remark_on_branches(std::vector<std::string>& remarks) const {
  if (turn_.turns() > 0)
    remarks.push_back(
        fmt::format("{} times the motion turned where branches pass each other, the last time at a distance "
                    "of {:.2g} rad or length scales: steps there were shortened to it",
                    turn_.turns(), turn_.gap_of_turn()));
  if (turn_.straight_on().times > 0) {
    const bool fixed = is_fixed();
    remarks.push_back(
        fmt::format("at {} the motion went straight on where two branches pass each other at a distance of "
                    "{:.2g} rad or length scales, too near for {} to follow the one that turns: what comes after is "
                    "right if they cross, as for dimensions that agree exactly; else {}",
                    instants_of(turn_.straight_on()), turn_.gap_straight_on(), fixed ? "steps of this length" : "steps",
                    fixed ? "take shorter ones" : "change those by 1e-9 or more"));
  }
  if (turn_.crossings().times > 0) {
    remarks.push_back(
        fmt::format("at {} two branches of the motion crossed, to rounding, and it went straight on, as for dimensions "
                    "that agree exactly",
                    instants_of(turn_.crossings())));
  }
  if (turn_.unjudged().times > 0) {
    remarks.push_back(fmt::format(
        "at {} the motion went straight on through a nearly singular position, and whether it kept to its branch was "
        "not judged, as {}: what comes after is right if branches cross there, as for dimensions that agree exactly",
        instants_of(turn_.unjudged()),
        branches_ ? "several combinations of constraints lose their gradients at once"
                  : "that is done for small mechanisms only"));
  }
}

}  // namespace catena
