// The builder behind build_model(): expands blocks, makes bodies, finds what elements hang on; what differs between
// element types is left to their fillers (element_filler.hpp). A template on the scalar, instantiated in one place.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "catena/base/curve.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/numbers/evaluation.hpp"

namespace catena {

template <class S>
class ModelBuilder {
 public:
  ModelBuilder(const SceneTemplate& scene, std::span<const S> parameters, const BuildOptions& options,
               Diagnostics& diagnostics)
      : scene_(scene),
        options_(options),
        diagnostics_(diagnostics),
        parameters_(parameters),
        evaluation_(*scene.source, scene.expressions, parameters, diagnostics,
                    scene.parameters.tables<S>(scene.expressions, parameters)) {}

  BasicModel<S> build();

  // What the fillers of element types use (element_filler.hpp).

  BasicModel<S>& model() { return model_; }
  const SceneTemplate& scene() const { return scene_; }
  S value(const NumberValue& number) const { return evaluation_(number); }
  Vec2<S> pair(std::uint32_t first) const { return {value(scene_.numbers[first]), value(scene_.numbers[first + 1])}; }
  /// Reports what is wrong with the text at `offset`, or at a byte of the string there; adds the values of k. In
  /// repeated blocks every place is reported once.
  void report(std::size_t offset, const std::string& message, std::size_t position = 0);
  /// Whether this place needs no further report, so that composing one can be spared.
  bool known_wrong(std::size_t offset) const {
    return diagnostics_.full() || (!evaluation_.loop_names().empty() && diagnostics_.reported(*scene_.source, offset));
  }
  /// Whether an error at this place was reported: consequences of a reported error are not reported.
  bool reported(std::size_t offset) const { return diagnostics_.reported(*scene_.source, offset); }
  /// The element that is being built, for messages: `revolute "A"`.
  std::string owner(const ElementTemplate& element) const;
  /// A law of state, put into the model: its number there; -1, with a report, if its names have no value.
  int state_law(const StateLawTemplate& source);
  /// Throws std::invalid_argument for data that define no function of time.
  TimeFunction<S> function(const FunctionTemplate& source);
  /// In the author's frame of its body. Throws std::invalid_argument.
  Curve<S> curve(const CurveTemplate& source);
  std::vector<Vec2<S>> table(const TableTemplate& source);
  /// Where a stop acts, from the name of its column; false, with a report, if there is no such column.
  bool find_column(const ElementTemplate& source, ElementEntry<Stop<S>, S>& stop);
  /// The same of the joint that rubs, from its name.
  bool find_column(const ElementTemplate& source, ElementEntry<Friction<S>, S>& friction);
  /// Adds the elements of a rope whose ends and numbers are in `entry`.
  void append_rope(const ElementTemplate& source, const ElementEntry<Rope<S>, S>& entry);
  /// Adds an element that is complete, under its name.
  template <class E>
  void append(const ElementTemplate& source, const ElementEntry<E, S>& entry, ElementKind kind);

 private:
  enum class Pass { bodies, elements, stops };

  bool count_elements();
  bool count_block(const BlockTemplate& block, std::int64_t& bodies, std::int64_t& elements);
  void visit(const BlockTemplate& block, Pass pass);
  void repeat(const BlockTemplate& block, Pass pass);
  std::int64_t integer(const NumberValue& number, std::string_view what);

  void add_body(const BodyTemplate& source);
  void add_points(int body, const BodyTemplate& source);
  /// What the body looks like: shapes that it is given for that, and those of its parts.
  void add_shapes(int body, const BodyTemplate& source);
  void compose(const BodyTemplate& source, std::string_view name, BasicBody<S>& body, Vec2<S>& centroid);
  void add_element(const ElementTemplate& source);
  bool make_name(const NameText& name, std::string& out);
  /// Reports tables that could not be made.
  void check_tables();
  /// Completes the laws of state, once everything else is there.
  void bind_laws();
  void report_used_name(const NameText& text, std::string_view name);
  bool attach(const AttachmentTemplate& attachment, const Vec2<S>* place, int& body, Vec2<S>& local);
  void report_missing_body(const NameText& text, std::string_view name);

  const SceneTemplate& scene_;
  const BuildOptions& options_;
  Diagnostics& diagnostics_;
  std::span<const S> parameters_;
  Evaluation<S> evaluation_;
  BasicModel<S> model_;
  std::vector<std::uint32_t> name_offset_;           // of every name in the model's table
  std::string name_, point_name_;                    // buffers
  std::vector<const StateLawTemplate*> law_source_;  // of every law in the model
  int searches_ = 0;                                 // for names like a missing one
  bool has_stops_ = false;                           // they name elements, wherever these are: built last
};

/// Builds one element: members from slots, what is missing from the configuration, appended to the model. `points` are
/// in the bodies' centroidal frames.
template <class S>
using ElementFiller = void (*)(ModelBuilder<S>& builder, const ElementTemplate& source, const int bodies[2],
                               const Vec2<S> points[2]);

/// The filler of a type, by its place in element_descriptions().
template <class S>
ElementFiller<S> element_filler(int type);

extern template ElementFiller<double> element_filler(int type);
extern template ElementFiller<Dual<double, 4>> element_filler(int type);

template <class S>
template <class E>
void ModelBuilder<S>::append(const ElementTemplate& source, const ElementEntry<E, S>& entry, ElementKind kind) {
  name_.clear();
  if (!source.name.empty() && !make_name(source.name, name_)) return;
  try {
    model_.append(name_, entry, kind);
    if (!name_.empty()) name_offset_.push_back(source.name.offset);
  } catch (const ModelError&) {
    report_used_name(source.name, name_);
  }
}

}  // namespace catena
