#include "catena/scene/running/drawn_shapes.hpp"

#include "catena/analysis/stability/modes.hpp"

namespace catena {

void draw_shapes(const AnalysisContext& context, Evaluator& evaluator, double t, std::span<const double> q,
                 const std::vector<std::vector<double>>& shapes) {
  if (!context.poses || q.empty()) return;
  const Plan& plan = evaluator.plan();
  evaluator.set_configuration(q);
  context.poses->pose({.evaluator = evaluator, .t = t, .q = q});
  std::vector<double> rates(static_cast<std::size_t>(plan.coordinates()), 0.0);
  for (const std::vector<double>& shape : shapes) {
    for (std::size_t c = 0; c < shape.size(); ++c) rates[static_cast<std::size_t>(plan.coordinate[c])] = shape[c];
    context.poses->shape(evaluator, rates);
  }
}

// Without masses, or with contacts that may open, there is no mode to show, and the equilibrium is none the worse for
// it: its report says nothing of it.
void draw_softest_mode(const AnalysisContext& context) {
  if (!context.poses || !context.model->gaps().empty()) return;
  Modes modes(context.model, {}, {.count = 1});
  modes.start_from(context.state);
  const ModesReport report = modes.run([&] { return !(context.cancel && context.cancel->load()); });
  if (!report.ok() || report.shapes.empty()) return;
  draw_shapes(context, modes.evaluator(), modes.time(), modes.q(), {report.shapes.front()});
}

}  // namespace catena
