#include "catena/scene/building/model_builder.hpp"

#include <fmt/format.h>

#include <cmath>

#include "catena/scene/describing/element_description.hpp"

namespace catena {

template <class S>
BasicModel<S> ModelBuilder<S>::build() {
  check_tables();
  model_.gravity = {value(scene_.gravity[0]), value(scene_.gravity[1])};
  if (!count_elements()) return std::move(model_);
  add_points(ground, scene_.ground);
  add_shapes(ground, scene_.ground);
  visit(scene_.root, Pass::bodies);
  visit(scene_.root, Pass::elements);
  if (has_stops_) visit(scene_.root, Pass::stops);
  for (const OwnColumnTemplate& source : scene_.own_columns) {
    OwnColumn<S> column{
        source.name, source.unit, source.expression.template formula<S>(parameters_, {}, evaluation_.tables()), {}};
    for (const NamedInput& input : source.inputs) column.inputs.push_back(input.name);
    model_.own_columns.push_back(std::move(column));
  }
  bind_laws();
  return std::move(model_);
}

// ---- Messages and names

template <class S>
void ModelBuilder<S>::report(std::size_t offset, const std::string& message, std::size_t position) {
  const std::size_t place = position == 0 ? offset : scene_.source->offset_in_string(offset, position);
  report_in_block(*scene_.source, place, message, evaluation_.loop_names(), evaluation_.loop_values(), diagnostics_);
}

template <class S>
bool ModelBuilder<S>::make_name(const NameText& name, std::string& out) {
  out.clear();
  if (name.pattern < 0) {
    out = name.text;
    return true;
  }
  return evaluation_.append_name(scene_.patterns[static_cast<std::size_t>(name.pattern)], name.offset, out);
}

template <class S>
void ModelBuilder<S>::report_used_name(const NameText& text, std::string_view name) {
  // A key given twice was reported when the text was parsed.
  if (known_wrong(text.offset) || diagnostics_.reported(*scene_.source, text.offset)) return;
  const int number = model_.names.find(name);
  const int target = model_.name_target[static_cast<std::size_t>(number)];
  const TextPlace first = scene_.source->place(name_offset_[static_cast<std::size_t>(number)]);
  report(text.offset, fmt::format("the name {} is used twice: {} in line {} has it already", in_quotes(name),
                                  target >= 0 ? "a body" : "an element", first.line));
}

// ---- Repeated blocks

template <class S>
std::int64_t ModelBuilder<S>::integer(const NumberValue& number, std::string_view what) {
  const double value = value_of(this->value(number));
  if (std::isnan(value)) return 0;
  if (value != std::round(value) || std::abs(value) > 9e15) {
    report(number.offset(), fmt::format("\"{}\" of a replicate block must be a whole number; it is {}", what, value));
    return 0;
  }
  return static_cast<std::int64_t>(value);
}

template <class S>
bool ModelBuilder<S>::count_block(const BlockTemplate& block, std::int64_t& bodies, std::int64_t& elements) {
  const std::int64_t count = integer(block.count, "count");
  if (count < 0) report(block.count.offset(), fmt::format("\"count\" of a replicate block is {}", count));
  if (count <= 0) return true;
  const auto too_many = [&] {
    if (bodies + elements <= options_.max_elements) return false;
    report(block.count.offset(),
           fmt::format("this scene has more than {} bodies and elements; --max-elements N allows more",
                       options_.max_elements));
    return true;
  };
  const auto own_bodies = static_cast<std::int64_t>(block.bodies.size());
  const auto own_elements = static_cast<std::int64_t>(block.elements.size());
  if (count > options_.max_elements / std::max<std::int64_t>(1, own_bodies + own_elements)) {
    bodies += options_.max_elements + 1;
    if (own_bodies + own_elements > 0 || !block.blocks.empty()) return !too_many();
    return true;  // an empty block
  }
  bodies += count * own_bodies;
  elements += count * own_elements;
  if (block.blocks.empty()) return !too_many();
  evaluation_.enter_block(block.variable);
  const std::int64_t first = integer(block.first, "first");
  bool good = true;
  for (std::int64_t k = 0; good && k < count; ++k) {
    evaluation_.set_variable(static_cast<double>(first + k));
    for (const BlockTemplate& nested : block.blocks) good = good && count_block(nested, bodies, elements);
  }
  evaluation_.leave_block();
  return good && !too_many();
}

template <class S>
bool ModelBuilder<S>::count_elements() {
  auto bodies = static_cast<std::int64_t>(scene_.root.bodies.size());
  auto elements = static_cast<std::int64_t>(scene_.root.elements.size());
  for (const BlockTemplate& block : scene_.root.blocks) {
    if (!count_block(block, bodies, elements)) return false;
  }
  if (bodies + elements > options_.max_elements) {
    report(0, fmt::format("this scene has {} bodies and elements, more than {}; --max-elements N allows more",
                          bodies + elements, options_.max_elements));
    return false;
  }
  model_.bodies.reserve(static_cast<std::size_t>(bodies));
  model_.elements.reserve(static_cast<std::size_t>(elements));
  constexpr std::size_t usual_length = 10;
  const auto names = static_cast<std::size_t>(bodies + elements);
  model_.names.reserve(names, usual_length * names);
  name_offset_.reserve(names);
  return true;
}

template <class S>
void ModelBuilder<S>::visit(const BlockTemplate& block, Pass pass) {
  using Section = BlockTemplate::Section;
  for (const Section& section : block.sections) {
    for (std::uint32_t k = section.first; k < section.last; ++k) {
      if (section.kind == Section::Kind::blocks) {
        repeat(block.blocks[k], pass);
      } else if (section.kind == Section::Kind::bodies && pass == Pass::bodies) {
        add_body(block.bodies[k]);
      } else if (section.kind == Section::Kind::elements && pass != Pass::bodies) {
        const bool stop = element_descriptions()[static_cast<std::size_t>(block.elements[k].type)].bodies == 0;
        has_stops_ = has_stops_ || stop;
        if (stop == (pass == Pass::stops)) add_element(block.elements[k]);
      }
    }
  }
}

template <class S>
void ModelBuilder<S>::repeat(const BlockTemplate& block, Pass pass) {
  const std::int64_t count = integer(block.count, "count"), first = integer(block.first, "first");
  evaluation_.enter_block(block.variable);
  for (std::int64_t k = 0; k < count && !diagnostics_.full(); ++k) {
    evaluation_.set_variable(static_cast<double>(first + k));
    visit(block, pass);
  }
  evaluation_.leave_block();
}

template class ModelBuilder<double>;
template class ModelBuilder<Dual<double, 4>>;

template <class S>
BasicModel<S> build_model(const SceneTemplate& scene, std::span<const S> parameters, const BuildOptions& options,
                          Diagnostics& diagnostics) {
  return ModelBuilder<S>(scene, parameters, options, diagnostics).build();
}

template BasicModel<double> build_model(const SceneTemplate&, std::span<const double>, const BuildOptions&,
                                        Diagnostics&);
template BasicModel<Dual<double, 4>> build_model(const SceneTemplate&, std::span<const Dual<double, 4>>,
                                                 const BuildOptions&, Diagnostics&);

}  // namespace catena
