// Drawings in the data of pages.
#include <charconv>
#include <cmath>

#include "catena/scene/viewing/view_document.hpp"
#include "catena/scene/viewing/view_json.hpp"

namespace catena {

ViewJson& ViewJson::rounded(double number) {
  separate();
  if (!std::isfinite(number)) {
    out_ += "null";
    return *this;
  }
  char text[32];
  const auto [end, code] = std::to_chars(text, text + sizeof text, static_cast<float>(number));
  out_.append(text, end);
  return *this;
}

ViewJson& ViewJson::packed(std::string_view type, const PackedNumbers& numbers) {
  open('{').key("type").text(type).key("data");
  out_ += '"';
  numbers.append_to(out_);
  out_ += '"';
  first_ = false;
  return close('}');
}

namespace {

void append_symbol(ViewJson& json, const DrawnSymbol& symbol) {
  json.open('{').key("lines").open('[');
  for (const DrawnLine& line : symbol.lines) {
    json.open('{').key("role").text(role_name(line.role));
    json.key("points").open('[');
    for (const Vec2<double>& p : line.points) json.rounded(p.x).rounded(p.y);
    json.close(']');
    if (line.radius > 0) json.key("radius").rounded(line.radius);
    if (line.closed) json.key("closed").value(true);
    if (line.filled) json.key("filled").value(true);
    if (line.width > 0) json.key("width").rounded(line.width);
    json.close('}');
  }
  json.close(']').close('}');
}

void append_shape(ViewJson& json, const DrawnShape& shape) {
  json.open('[').value(static_cast<std::int64_t>(shape.anchor)).value(std::int64_t{shape.symbol});
  json.value(std::int64_t{shape.element});
  json.value(std::int64_t{shape.anchor == Anchor::rope ? shape.rope : shape.body_i});
  json.rounded(shape.point_i.x).rounded(shape.point_i.y).value(std::int64_t{shape.body_j});
  json.rounded(shape.point_j.x).rounded(shape.point_j.y).close(']');
}

void append_ropes(ViewJson& json, const std::vector<RopePath>& ropes) {
  json.key("ropes").open('[');
  for (const RopePath& rope : ropes) {
    json.open('{').key("nodes").open('[');
    for (const RopeNode& node : rope.nodes) {
      json.value(std::int64_t{node.body});
      json.rounded(node.centre.x).rounded(node.centre.y).rounded(node.radius);
    }
    json.close(']').key("leads_on").value(rope.leads_on).close('}');
  }
  json.close(']');
}

}  // namespace

void append_drawing(ViewJson& json, const Model& model, const Drawing& drawing) {
  json.key("symbols").open('[');
  for (const DrawnSymbol& symbol : drawing.symbols) append_symbol(json, symbol);
  json.close(']').key("shapes").open('[');
  for (const DrawnShape& shape : drawing.shapes) append_shape(json, shape);
  json.close(']').key("loads").open('[');
  for (const DrawnLoad& load : drawing.loads) {
    json.open('{').key("element").value(std::int64_t{load.element}).key("body").value(std::int64_t{load.body});
    json.key("point").open('[').rounded(load.point.x).rounded(load.point.y).close(']');
    json.key("in_body_axes").value(load.in_body_axes).close('}');
  }
  json.close(']');
  if (!drawing.ropes.empty()) append_ropes(json, drawing.ropes);
  json.key("typical_length").rounded(drawing.typical_length).key("given").open('[');
  for (const Frame<double>& frame : given_poses(model)) json.value(frame.x).value(frame.y).value(frame.phi);
  json.close(']');
}

}  // namespace catena
