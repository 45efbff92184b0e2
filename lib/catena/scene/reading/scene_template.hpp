// A compiled scene: the content of its text without JSON, with names and numbers ready to be evaluated, nothing
// expanded.
//
// A replicate block is kept once, whatever its count; names and numbers in it are made as often as it is repeated
// (build_model.hpp). Numbers of bodies and elements lie in one array, those given only, so that a scene written out for
// 10^5 links stays small. Offsets are bytes in the source, for messages.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string_view>
#include <vector>

#include "catena/base/spline.hpp"
#include "catena/model/model.hpp"
#include "catena/scene/json/json_document.hpp"
#include "catena/scene/numbers/name_template.hpp"
#include "catena/scene/numbers/number_value.hpp"
#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/numbers/parameter_table.hpp"

namespace catena {

/// A name as it stands in the document, or the number of its template if it has braces.
struct NameText {
  std::string_view text;
  int pattern = -1;
  std::uint32_t offset = 0;    ///< of the JSON string it stands in
  std::uint32_t position = 0;  ///< first byte within that string

  bool empty() const { return text.empty(); }
};

struct FunctionTemplate {
  /// state: a law of state, for forces alone
  enum class Kind : unsigned char { constant, polynomial, harmonic, step, law, spline, sum, product, state };
  Kind kind = Kind::constant;
  SplineEnd end = SplineEnd::natural;
  Beyond beyond = Beyond::error;
  int order = 5;  // of a step
  MotionLaw law = MotionLaw::cycloidal;
  std::uint32_t offset = 0;  // of the value in the text
  int state = -1;            // of a law of state: its number in the scene
  /// constant: 1; polynomial: coefficients; harmonic: amplitude, omega, phase, offset; step, law: t0, t1, from, to;
  /// spline: all times, then all values
  std::vector<NumberValue> numbers;
  std::vector<FunctionTemplate> parts;
};

struct CurveTemplate {
  enum class Kind : unsigned char { circle, spline, polar, line };
  Kind kind = Kind::circle;
  SplineEnd end = SplineEnd::natural;
  Beyond beyond = Beyond::error;
  std::uint32_t offset = 0;
  /// circle: centre, radius; spline: x', y' point after point; polar: all angles, then all radii; line: point, axis
  std::vector<NumberValue> numbers;
};

/// Pairs of numbers, one after the other.
struct TableTemplate {
  Beyond beyond = Beyond::error;
  std::uint32_t offset = 0;
  std::vector<NumberValue> numbers;
};

/// Where an element takes hold of a body.
struct AttachmentTemplate {
  enum class Form : unsigned char { absent, origin, point, local };
  NameText body;
  NameText point;  ///< of the form `point`
  Form form = Form::absent;
};

/// One of the pulleys of a rope.
struct PulleyTemplate {
  AttachmentTemplate attachment;
  NumberValue place[2];  ///< of an attachment `local`
  NumberValue radius, mu;
  int side = 0;  ///< 0: not given
  bool rolls = false, has_radius = false, has_mu = false;
  std::uint32_t offset = 0;
};

/// The optional numbers of a body, in the order in which they are stored; pairs take two.
enum class BodyNumber : unsigned char {
  mass,
  inertia,
  position_x,
  position_y,
  angle,
  velocity_x,
  velocity_y,
  angular_velocity,
  centroid_x,
  centroid_y,
  from_x,
  from_y,
  to_x,
  to_y,
};
inline constexpr int body_numbers = 14;

struct PointTemplate {
  NameText name;
  NumberValue x, y;
};

/// A part of a body: a mass, or a shape of uniform density. What a body looks like is given by shapes too, without
/// mass, and by lines.
struct PartTemplate {
  enum class Shape : unsigned char { mass, rectangle, disc, polygon, line };
  Shape shape = Shape::mass;
  std::uint32_t offset = 0;
  NumberValue mass;
  /// mass: centroid, inertia; rectangle: centre, width, height, angle; disc: centre, radius; polygon and line:
  /// corners
  std::vector<NumberValue> numbers;
};

struct BodyTemplate {
  NameText name;
  std::uint32_t offset = 0;        ///< of its object
  std::uint32_t first_number = 0;  ///< of those given, in the order of BodyNumber
  std::uint16_t given = 0;         ///< bit k: BodyNumber k is given
  bool fixed = false, particle = false, hold_x = false, hold_y = false, hold_angle = false;
  std::uint32_t first_point = 0, points = 0;
  std::uint32_t first_part = 0, parts = 0;
  std::uint32_t first_drawn = 0, drawn = 0;  ///< among the scene's `drawn`

  bool has(BodyNumber number) const { return (given >> static_cast<int>(number)) & 1; }
};

struct ElementTemplate {
  NameText name;  ///< may be empty
  std::uint32_t offset = 0;
  ElementKind kind = ElementKind::constraint;
  bool faulty = false;             ///< an error in its text was reported: what follows from that is not
  bool has_at = false;             ///< its points follow from a place in the ground frame
  short type = 0;                  ///< in element_descriptions()
  std::uint32_t first_number = 0;  ///< first of its slots; after them, if has_at, the place
  std::uint32_t given = 0;         ///< bit k: field k is given
  std::uint32_t indirect = 0;      ///< bit k: slot k holds the number of a function, curve, table or list of pulleys
  AttachmentTemplate attachment[2];
};

struct BlockTemplate {
  struct Section {
    enum class Kind : unsigned char { bodies, elements, blocks };
    Kind kind;
    std::uint32_t first, last;
  };
  std::uint32_t offset = 0;
  NumberValue count, first;
  std::string_view variable;
  std::vector<BodyTemplate> bodies;
  std::vector<ElementTemplate> elements;
  std::vector<BlockTemplate> blocks;
  std::vector<Section> sections;  ///< in the order of the text
};

/// A column of the scene's own, or an expression that stands where a column may: its name is then its text, "=a.x-b.x".
struct OwnColumnTemplate {
  std::string name, unit;
  Expression expression;
  std::vector<NamedInput> inputs;
  JsonValue place;  ///< the text of the expression
};

/// The magnitude of a force as an expression over columns.
struct StateLawTemplate {
  Expression expression;
  std::vector<NamedInput> inputs;
  std::vector<int> patterns;  ///< by input: of its name in the scene's patterns, -1: it has no braces
  JsonValue place;            ///< the text of the expression
};

/// What slots of elements hold the number of.
struct IndirectTemplates {
  std::vector<FunctionTemplate> functions;
  std::vector<CurveTemplate> curves;
  std::vector<TableTemplate> tables;
  std::vector<std::vector<PulleyTemplate>> ropes;  ///< what each runs over
};

struct SceneTemplate {
  std::unique_ptr<SourceText> source;
  std::unique_ptr<JsonDocument> document;  ///< names are views into it
  std::string_view name, description;
  ParameterTable parameters;
  ExpressionPool expressions;
  NumberValue gravity[2];
  BodyTemplate ground;  ///< its points
  BlockTemplate root;

  std::vector<NumberValue> numbers;
  std::vector<NameTemplate> patterns;
  std::vector<PointTemplate> points;
  std::vector<PartTemplate> parts, drawn;
  IndirectTemplates indirect;
  std::vector<OwnColumnTemplate> own_columns;
  std::vector<StateLawTemplate> state_laws;
  OutputUnits::Wishes units;  ///< in which results are shown

  std::vector<std::unique_ptr<SourceText>> data_files;  ///< that tables were read from
  std::vector<std::string> notes;                       ///< what reports are to say of them

  JsonValue analyses, outputs;  ///< read by analysis_reader.hpp
  bool may_lack_parts = false;  ///< a key of the scene is none: what is in it is missing, and names in it are unknown
};

}  // namespace catena
