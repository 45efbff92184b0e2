#include "catena/analysis/whole_turns.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

}  // namespace

void move_whole_turns(const Evaluator& evaluator, std::span<double> q) {
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  struct Tie {
    int body, other;
  };
  struct Turn {
    int body;
    double by;
  };
  std::vector<Turn> turns;
  std::vector<Tie> ties;
  const auto turns_off = [](double misfit) { return std::round(misfit / (2 * std::numbers::pi)); };
  const auto body_of = [&](int model_body) { return model_body < 0 ? -1 : plan.plan_body[at(model_body)]; };
  const auto angle = [&](int body) { return body < 0 ? 0.0 : q[at(3 * body + 2)]; };
  for (const auto& entry : std::get<std::vector<ElementEntry<AbsoluteAngle<double>, double>>>(model.constraints)) {
    const int body = body_of(entry.i);
    const double k = turns_off(evaluator.element_value(entry.id).f - angle(body));
    if (k != 0) turns.push_back({body, k});
  }
  for (const auto& entry : std::get<std::vector<ElementEntry<RelativeAngle<double>, double>>>(model.constraints)) {
    const int i = body_of(entry.i), j = body_of(entry.j);
    const double k = turns_off(evaluator.element_value(entry.id).f - (angle(j) - angle(i)));
    if (k != 0) {
      if (j >= 0 && j < plan.moving)
        turns.push_back({j, k});
      else
        turns.push_back({i, -k});
    } else if (i >= 0 && j >= 0) {
      ties.push_back({i, j});
    }
  }
  if (turns.empty()) return;
  for (const auto& entry : std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints)) {
    if (entry.i >= 0 && entry.j >= 0) ties.push_back({body_of(entry.i), body_of(entry.j)});
  }
  std::vector<std::vector<int>> tied(at(plan.bodies));
  for (const Tie& tie : ties) tied[at(tie.body)].push_back(tie.other), tied[at(tie.other)].push_back(tie.body);
  std::vector<char> moved(at(plan.bodies), 0);
  for (const Turn& turn : turns) {
    if (turn.body < 0 || turn.body >= plan.moving || moved[at(turn.body)]) continue;
    std::vector<int> queue = {turn.body};
    moved[at(turn.body)] = 1;
    for (std::size_t head = 0; head < queue.size(); ++head) {
      q[at(3 * queue[head] + 2)] += turn.by * 2 * std::numbers::pi;
      for (int other : tied[at(queue[head])]) {
        if (!moved[at(other)] && other < plan.moving) moved[at(other)] = 1, queue.push_back(other);
      }
    }
  }
}

}  // namespace catena
