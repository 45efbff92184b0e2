// The pulleys of a rope: from JSON to templates.
#include <fmt/format.h>

#include <array>

#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 5> pulley_keys{"at", "radius", "side", "pulley", "mu"};
constexpr std::array<std::string_view, 2> ways{"slides", "rolls"};

}  // namespace

int SceneReading::pulleys(const JsonValue& value, const FieldName& field) {
  std::vector<PulleyTemplate> all;
  const auto keep_all = [&] {
    scene.indirect.ropes.push_back(std::move(all));
    return static_cast<int>(scene.indirect.ropes.size()) - 1;
  };
  if (!value.is(JsonKind::array)) {
    error(value, fmt::format("{} must be a list of pulleys {{\"at\", \"radius\", ...}}; this is {}", field.text(),
                             describe(value.kind())));
    return keep_all();
  }
  if (value.size() == 0) {
    error(value, field.text() + " must name at least one pulley: a rope that runs straight is a cable");
    return keep_all();
  }
  for (const JsonValue& object : value.elements()) {
    const std::string owner = fmt::format("pulley {} of {}", all.size() + 1, field.text());
    PulleyTemplate& pulley = all.emplace_back();
    pulley.offset = static_cast<std::uint32_t>(object.offset());
    std::array<JsonValue, pulley_keys.size()> v;
    if (!read_members(object, pulley_keys, owner, v, diagnostics)) continue;
    const auto& [at, radius, side, way, mu] = v;
    if (at) {
      attachment(at, "at", owner, false, pulley.attachment, pulley.place);
    } else {
      error(object, owner + " needs \"at\", the place of its centre");
    }
    if (radius) {
      pulley.has_radius = true;
      pulley.radius = numbers.read(radius, UnitKind::length, {"radius", owner});
    }
    if (side) {
      const bool good = side.is(JsonKind::number) && (side.number() == 1 || side.number() == -1);
      if (good) {
        pulley.side = static_cast<int>(side.number());
      } else {
        error(side, fmt::format("{} must be 1, on the left of the rope from i to j, or -1, on its right",
                                FieldName{"side", owner}.text()));
      }
    }
    if (way) pulley.rolls = read_word(way, ways, {"pulley", owner}, diagnostics) == 1;
    if (mu) {
      pulley.mu = numbers.read(mu, UnitKind::none, {"mu", owner});
      pulley.has_mu = true;
    }
  }
  return keep_all();
}

}  // namespace catena
