#include "catena/scene/running/singular_entries.hpp"

namespace catena {
namespace {

/// The branches in words; where none goes on, that.
std::vector<std::string> branches_of(const SingularPoint& point) {
  if (!point.branches.empty()) return point.branches;
  if (point.at_infinity) return {"none: the place lies at infinity"};
  if (point.kind == SingularPoint::Kind::lock_up) return {"none goes on beyond the dead point"};
  return {point.kind == SingularPoint::Kind::isolated ? "none goes on" : "not known"};
}

}  // namespace

void add_singular_points(AnalysisResult& result, const std::vector<SingularPoint>& points, const Model& model) {
  if (points.empty()) return;
  std::vector<FieldRecord> records;
  for (const SingularPoint& point : points) {
    FieldRecord record{{"t", point.t},
                       {"kind", std::string(point.kind_name())},
                       {"nullity", std::int64_t{point.nullity}},
                       {"bodies", point.bodies},
                       {"branches", branches_of(point)}};
    if (point.driver >= 0) {
      record.emplace_back("driver", model.element_name(point.driver));
      record.emplace_back("value", point.driver_value);
    }
    records.push_back(std::move(record));
  }
  result.fields.push_back({"singular", std::move(records)});
}

void add_estimated_error(AnalysisResult& result, const EstimatedError& error, const Model& model) {
  struct Kind {
    const char *quantity, *unit;
    const ErrorOfMotion& of;
  };
  const Kind kinds[] = {{"position", "m", error.position},
                        {"angle", "rad", error.angle},
                        {"velocity", "m/s", error.velocity},
                        {"angular velocity", "rad/s", error.angular_velocity}};
  std::vector<FieldRecord> records;
  for (const Kind& kind : kinds) {
    FieldRecord record{{"quantity", std::string(kind.quantity)},
                       {"error", kind.of.error},
                       {"unit", std::string(kind.unit)},
                       {"relative", kind.of.relative()}};
    if (kind.of.body >= 0) {
      record.emplace_back("body", std::string(model.body_name(kind.of.body)));
      record.emplace_back("t", kind.of.t);
    }
    records.push_back(std::move(record));
  }
  result.fields.push_back({"estimated_error", std::move(records)});
}

}  // namespace catena
