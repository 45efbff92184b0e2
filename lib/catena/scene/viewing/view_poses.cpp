// Poses in the data of pages: exact to single precision while they are few, else in 16 bits a coordinate.
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

struct Range {
  double low = INFINITY, high = -INFINITY;

  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double first() const { return low <= high ? low : 0; }
  double span() const { return low <= high ? high - low : 0; }
};

/// Of x (part 0), y (1) or angles (2) of all bodies in all poses.
Range range_of(const RecordedAnalysis& analysis, std::size_t part) {
  Range range;
  for (std::size_t k = 0; k < analysis.poses.size(); ++k) {
    const std::span<const double> pose = analysis.poses[k];
    for (std::size_t b = 0; b < analysis.layout.bodies; ++b) range.include(pose[PoseLayout::frames + 3 * b + part]);
  }
  return range;
}

std::uint16_t level_of(double value, double first, double step) {
  if (!std::isfinite(value) || !(step > 0)) return 0;
  return static_cast<std::uint16_t>(std::clamp(std::round((value - first) / step), 0.0, levels));
}

std::uint16_t angle_level(double angle) {
  if (!std::isfinite(angle)) return 0;
  const double turns = angle / (2 * std::numbers::pi);
  return static_cast<std::uint16_t>(static_cast<std::int64_t>(std::round((turns - std::floor(turns)) * angle_levels)) &
                                    0xffff);
}

void append_pair(ViewJson& json, std::string_view key, double offset, double step) {
  json.key(key).open('[').value(offset).value(step).close(']');
}

void append_frames(ViewJson& json, const RecordedAnalysis& analysis) {
  const std::size_t bodies = analysis.layout.bodies, poses = analysis.poses.size();
  const Range x = range_of(analysis, 0), y = range_of(analysis, 1);
  const bool exact = 3 * bodies * poses <= most_exact;
  const double origin[2] = {x.first() + x.span() / 2, y.first() + y.span() / 2};
  const double step[2] = {x.span() / levels, y.span() / levels};
  json.key("frames").open('{').key("type").text(exact ? "float32" : "uint16");
  append_pair(json, "x", exact ? origin[0] : x.first(), exact ? 1 : step[0]);
  append_pair(json, "y", exact ? origin[1] : y.first(), exact ? 1 : step[1]);
  append_pair(json, "angle", 0, exact ? 1 : 2 * std::numbers::pi / angle_levels);
  PackedNumbers packed;
  packed.reserve(3 * bodies * poses * (exact ? 4 : 2));
  for (std::size_t k = 0; k < poses; ++k) {
    const std::span<const double> frames = analysis.poses[k].subspan(PoseLayout::frames, 3 * bodies);
    for (std::size_t b = 0; b < 3 * bodies; b += 3) {
      if (exact) {
        packed.add_float(frames[b] - origin[0]);
        packed.add_float(frames[b + 1] - origin[1]);
        packed.add_float(frames[b + 2]);
      } else {
        packed.add_short(level_of(frames[b], x.first(), step[0]));
        packed.add_short(level_of(frames[b + 1], y.first(), step[1]));
        packed.add_short(angle_level(frames[b + 2]));
      }
    }
  }
  json.key("data");
  std::string& out = json.text_of_value();
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
