// Shared by the readers of a scene's parts: the scene under construction, the place for errors, and the reading of
// objects, names, words and flags with the checks of every key.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "catena/scene/numbers/number_reader.hpp"
#include "catena/scene/reading/scene_template.hpp"

namespace catena {

/// Reports what stands at `value`.
void report(const JsonValue& value, std::string message, Diagnostics& diagnostics);

/// Treatment of an unknown key that is near to a known one that is not given: it is ignored, or taken for that one and
/// reported first, so that consequences of the misspelling are not reported.
enum class Misspelt { left_out, as_meant };

/// Finds the members of an object by their keys: out[k] is the value of keys[k], absent if it is not given. Keys that
/// are none of these are reported, with the nearest one. False, with a report, if `object` is no object.
bool read_members(const JsonValue& object, std::span<const std::string_view> keys, std::string_view owner,
                  std::span<JsonValue> out, Diagnostics& diagnostics, Misspelt misspelt = Misspelt::left_out);

/// The key that a member of the object stands for: its own, or the one of `keys` that it misspells; else empty.
std::string_view meant_key(const JsonValue& object, const JsonMember& member, std::span<const std::string_view> keys);

/// The only member of an object whose key says what it is, such as {"harmonic": ...}; nothing, with a report, if there
/// is none or more. `what` is what the keys name: "function of time".
std::optional<JsonMember> read_only_member(const JsonValue& object, std::span<const std::string_view> keys,
                                           const FieldName& field, std::string_view what, Diagnostics& diagnostics);

/// true or false.
bool read_flag(const JsonValue& value, const FieldName& field, Diagnostics& diagnostics);
/// One of some words: its position, -1 with a report if it is none.
int read_word(const JsonValue& value, std::span<const std::string_view> words, const FieldName& field,
              Diagnostics& diagnostics);
/// A text; empty, with a report, if it is none.
std::string_view read_string(const JsonValue& value, const FieldName& field, Diagnostics& diagnostics);

struct DataColumns;

class SceneReading {
 public:
  SceneReading(SceneTemplate& the_scene, Diagnostics& all_diagnostics)
      : scene(the_scene),
        diagnostics(all_diagnostics),
        numbers(the_scene.parameters.names(), the_scene.expressions, all_diagnostics) {}

  /// The word for the continuation beyond the ends of a table or curve; a periodic one has none.
  Beyond beyond(const JsonValue& value, SplineEnd end, std::string_view owner);
  void error(const JsonValue& value, std::string message) { report(value, std::move(message), diagnostics); }

  /// A name, or a part of one: text[from, to) of the string. Rules for names are not checked.
  NameText name(const JsonValue& string, std::size_t from = 0, std::size_t to = std::string_view::npos);
  /// The name with 0 for every expression, on which rules are checked.
  std::string sample(const NameText& name) const;
  /// Appends numbers to the scene's array; returns the place of the first.
  std::uint32_t keep(std::span<const NumberValue> values);

  /// A function of time in `unit`: its number in the scene, or -1 where a plain number was found and put into `plain`.
  /// Functions of a product have no unit of their own.
  int function(const JsonValue& value, const ExpectedDimension& unit, const FieldName& field, NumberValue& plain);
  /// The object "tables" of the scene, whose names are known.
  void table_functions(const JsonValue& object, std::span<const std::string> names);
  /// A law of state, an expression that names columns or t, as a function: its number in the scene; -1 where the value
  /// is something else.
  int state_law(const JsonValue& value, const FieldName& field);
  /// A curve in a body frame: its number.
  int curve(const JsonValue& value, const FieldName& field);
  /// A list of numbers, or a column of a file: their values.
  std::vector<NumberValue> number_list(const JsonValue& value, const ExpectedDimension& dimension,
                                       const FieldName& field);
  /// What pairs are, to smooth measured ones: places of a curve, else values over their places; whether they repeat.
  struct PairUse {
    bool places = false, repeats = false;
    std::span<const std::string_view> beside{};  ///< keys that stand beside those of a file
  };
  /// A list of pairs, or two columns of a file: the numbers of one pair after those of the other.
  std::vector<NumberValue> pair_list(const JsonValue& value, const ExpectedDimension& first,
                                     const ExpectedDimension& second, const FieldName& field, const PairUse& use);
  /// A list of pairs, or an object with it and what is beyond its ends: its number.
  int table(const JsonValue& value, UnitKind first, UnitKind second, const FieldName& field);

  /// What a rope runs over: its number.
  int pulleys(const JsonValue& value, const FieldName& field);

  /// Where an element holds a body: `local` takes a place in the body's frame, and may be none.
  void attachment(const JsonValue& value, std::string_view key, std::string_view owner, bool has_at,
                  AttachmentTemplate& attachment, NumberValue* local);
  void body(const JsonMember& member, BlockTemplate& block);
  void element(const JsonValue& object, std::string_view list, BlockTemplate& block);
  /// The member `key` of a scene or replicate block that holds bodies, elements or blocks.
  void section(std::string_view key, const JsonValue& value, BlockTemplate& block, int depth);
  void block(const JsonValue& object, BlockTemplate& parent, int depth);

  SceneTemplate& scene;
  Diagnostics& diagnostics;
  NumberReader numbers;

 private:
  /// Smooths columns of a file, and notes what is left between both.
  void smooth(DataColumns& columns, const PairUse& use, const FieldName& field);
  FunctionTemplate function_object(const JsonValue& value, const ExpectedDimension& unit, const FieldName& field);
  FunctionTemplate function_part(const JsonValue& value, const ExpectedDimension& unit, const FieldName& field);
  void curve_of_kind(const JsonMember& member, const FieldName& field, CurveTemplate& result);
  /// A polar curve by pairs of angle and radius, v[2].
  void polar_pairs(std::span<const JsonValue> v, std::span<const std::string_view> names, const std::string& owner,
                   CurveTemplate& result);
  void part(const JsonValue& object, std::string_view owner);
  void part_list(const JsonValue& parts, const std::string& owner, BodyTemplate& body);
  /// The numbers of the one shape of these that is given; false if none is.
  bool shape(const JsonValue& rectangle, const JsonValue& disc, const JsonValue& polygon, const std::string& owner,
             PartTemplate& part);
  void corners(const JsonValue& list, std::size_t least, const FieldName& field, PartTemplate& part);
  /// Shapes without mass: what the body looks like.
  void drawn_shapes(const JsonValue& list, std::string_view body_owner, BodyTemplate& body);
  void ground_body(const JsonValue& value);
  void point_list(const JsonValue& value, BodyTemplate& body, std::string_view owner);
};

}  // namespace catena
