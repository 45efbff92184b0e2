// Poses in the data of pages: exact to single precision while they are few, else in 16 bits a coordinate. Each body's
// places count from a base of its own, so that a mechanism of kilometres shows the play of its links.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catena/scene/viewing/packed_numbers.hpp"
#include "catena/scene/viewing/view_document.hpp"
#include "catena/scene/viewing/view_json.hpp"

namespace catena {
namespace {

// Beyond this many coordinates single precision would make pages of tens of megabytes: 5.3 bytes each in base64.
constexpr std::size_t most_exact = 2'000'000;
constexpr double levels = 65535, angle_levels = 65536;

/// Where a body is at its lowest x and y, and how far it moves from there.
struct Reach {
  Vec2<double> low{INFINITY, INFINITY}, high{-INFINITY, -INFINITY};

  void include(double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    low = {std::min(low.x, x), std::min(low.y, y)};
    high = {std::max(high.x, x), std::max(high.y, y)};
  }
  Vec2<double> base() const { return low.x <= high.x ? low : Vec2<double>{}; }
  Vec2<double> span() const { return low.x <= high.x ? high - low : Vec2<double>{}; }
};

std::vector<Reach> reaches_of(const RecordedAnalysis& analysis) {
  std::vector<Reach> reaches(analysis.layout.bodies);
  for (std::size_t k = 0; k < analysis.poses.size(); ++k) {
    const std::span<const double> frames = analysis.poses[k].subspan(PoseLayout::frames, 3 * reaches.size());
    for (std::size_t b = 0; b < reaches.size(); ++b) reaches[b].include(frames[3 * b], frames[3 * b + 1]);
  }
  return reaches;
}

/// The number of steps from the base; the farthest body needs all levels.
std::uint16_t level_of(double away, double step) {
  if (!std::isfinite(away) || !(step > 0)) return 0;
  return static_cast<std::uint16_t>(std::clamp(std::round(away / step), 0.0, levels));
}

std::uint16_t angle_level(double angle) {
  if (!std::isfinite(angle)) return 0;
  const double turns = angle / (2 * std::numbers::pi);
  return static_cast<std::uint16_t>(static_cast<std::int64_t>(std::round((turns - std::floor(turns)) * angle_levels)) &
                                    0xffff);
}

void append_frames(ViewJson& json, const RecordedAnalysis& analysis) {
  const std::vector<Reach> reaches = reaches_of(analysis);
  const std::size_t bodies = reaches.size(), poses = analysis.poses.size();
  const bool exact = 3 * bodies * poses <= most_exact;
  PackedNumbers base, packed;
  Vec2<double> most{};
  for (const Reach& reach : reaches) {
    base.add_double(reach.base().x);
    base.add_double(reach.base().y);
    most = {std::max(most.x, reach.span().x), std::max(most.y, reach.span().y)};
  }
  const Vec2<double> step = exact ? Vec2<double>{1, 1} : most / levels;
  packed.reserve(3 * bodies * poses * (exact ? 4 : 2));
  for (std::size_t k = 0; k < poses; ++k) {
    const std::span<const double> frames = analysis.poses[k].subspan(PoseLayout::frames, 3 * bodies);
    for (std::size_t b = 0; b < bodies; ++b) {
      const Vec2<double> away = Vec2<double>{frames[3 * b], frames[3 * b + 1]} - reaches[b].base();
      if (exact) {
        packed.add_float(away.x);
        packed.add_float(away.y);
        packed.add_float(frames[3 * b + 2]);
      } else {
        packed.add_short(level_of(away.x, step.x));
        packed.add_short(level_of(away.y, step.y));
        packed.add_short(angle_level(frames[3 * b + 2]));
      }
    }
  }
  json.key("frames").open('{').key("type").text(exact ? "float32" : "uint16");
  json.key("step").open('[').value(step.x).value(step.y);
  json.value(exact ? 1 : 2 * std::numbers::pi / angle_levels).close(']');
  json.key("base").packed("float64", base);
  std::string& out = json.key("data").text_of_value();
  out += '"';
  packed.append_to(out);
  out += '"';
  json.close('}');
}

/// The values from `first` to before `last` of every pose; nothing where none of them is known.
PackedNumbers part_of(const RecordedAnalysis& analysis, std::size_t first, std::size_t last, bool& known) {
  PackedNumbers packed;
  known = false;
  for (std::size_t k = 0; k < analysis.poses.size(); ++k) {
    for (std::size_t c = first; c < last; ++c) {
      packed.add_float(analysis.poses[k][c]);
      known = known || std::isfinite(analysis.poses[k][c]);
    }
  }
  return packed;
}

}  // namespace

void append_poses(ViewJson& json, const RecordedAnalysis& analysis) {
  const PoseLayout& layout = analysis.layout;
  json.open('{').key("count").count(analysis.poses.size()).key("total").value(analysis.poses.seen());
  json.key("stride").value(analysis.poses.stride());
  PackedNumbers t;
  for (std::size_t k = 0; k < analysis.poses.size(); ++k) t.add_double(analysis.poses[k][PoseLayout::time]);
  json.key("t").packed("float64", t);
  append_frames(json, analysis);
  json.key("arrows").value(layout.arrows);
  bool known = false;
  if (const auto packed = part_of(analysis, layout.velocities(), layout.reaction_forces(), known); known)
    json.key("velocities").packed("float32", packed);
  if (const auto packed = part_of(analysis, layout.reaction_forces(), layout.load_forces(), known); known) {
    json.key("reactions").open('{').key("elements").open('[');
    for (const int element : layout.reactions) json.value(std::int64_t{element});
    json.close(']');
    json.key("values").packed("float32", packed);
    json.close('}');
  }
  if (const auto packed = part_of(analysis, layout.load_forces(), layout.width(), known); known)
    json.key("loads").packed("float32", packed);
  json.close('}');
}

}  // namespace catena
