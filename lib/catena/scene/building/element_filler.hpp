// Fills the members of an element type from the slots of its template: one function a type, made from its fields().
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "catena/elements/all.hpp"
#include "catena/model/given_frames.hpp"
#include "catena/model/model_add.hpp"
#include "catena/scene/building/model_builder.hpp"
#include "catena/scene/describing/element_description.hpp"
#include "catena/scene/numbers/number_domain.hpp"

namespace catena {
namespace filling {

inline constexpr const char* zero_distance =
    "a distance of zero makes the equation vanish; use absolute_x and absolute_y, or a revolute joint, instead";

/// Fills the members of one element; run() returns false if anything was reported.
template <class E, class S>
class Filler {
 public:
  Filler(ModelBuilder<S>& builder, const ElementTemplate& source, ElementEntry<E, S>& entry, const Vec2<S>* points)
      : builder_(builder), source_(source), entry_(entry), points_(points) {}

  bool run() {
    const auto take_all = [&](const auto&... field) { (take(field), ...); };
    if constexpr (requires { E::keys(); }) {
      std::apply(take_all, E::keys());
    } else {
      std::apply(take_all, E::fields());
    }
    return good_;
  }
  /// The text of the value c, or of the element where it was left out.
  std::size_t value_offset() const { return value_offset_; }
  bool value_given() const { return value_given_; }

 private:
  template <class Field>
  void take(const Field& field) {
    constexpr int width = slots_of(kind_of(Field{}));
    const int slot = slot_, number = field_;
    slot_ += width;
    ++field_;
    const bool given = (source_.given >> number) & 1;
    if constexpr (kind_of(Field{}) == FieldKind::point) {
      entry_.element.*field.member = points_[field.body];
    } else {
      if (given) set(field, source_.first_number + static_cast<std::uint32_t>(slot), slot);
      if constexpr (requires { field.required; }) {
        if constexpr (requires { field.unless; }) {
          if (!given && field.required && field.unless.empty()) good_ = false;  // reported by the reader
        } else {
          if (!given && field.required) good_ = false;
        }
      }
    }
  }

  const NumberValue& number(std::uint32_t at) const { return builder_.scene().numbers[at]; }
  void wrong(std::size_t offset, std::string_view key, std::string_view what) {
    good_ = false;
    if (builder_.known_wrong(offset)) return;
    builder_.report(offset, in_quotes(key) + " of " + builder_.owner(source_) + " " + std::string(what));
  }

  template <class M>
  void set(const AxisField<M>& field, std::uint32_t at, int) {
    const Vec2<S> axis = builder_.pair(at);
    const double size = value_of(axis.x) * value_of(axis.x) + value_of(axis.y) * value_of(axis.y);
    if (size == 0) wrong(number(at).offset(), field.key, "has no direction: both components are zero");
    entry_.element.*field.member = axis;
  }
  template <class M>
  void set(const PlaceField<M>& field, std::uint32_t at, int) {
    entry_.element.*field.member = builder_.pair(at);
  }
  template <class M>
  void set(const NumberField<M>& field, std::uint32_t at, int) {
    const S value = builder_.value(number(at));
    if (!fits(value_of(value), field.domain)) {
      wrong(number(at).offset(), field.key, out_of_domain(value_of(value), field.domain));
    }
    entry_.element.*field.member = value;
  }
  template <class M>
  void set(const BoundField<M>& field, std::uint32_t at, int) {
    const S value = builder_.value(number(at));
    if (!fits(value_of(value), field.domain)) {
      wrong(number(at).offset(), field.key, out_of_domain(value_of(value), field.domain));
    }
    entry_.element.*field.member = value;
  }
  void set(const ColumnField&, std::uint32_t, int) {}   // resolved before
  void set(const PulleysField&, std::uint32_t, int) {}  // taken when the rope is made
  template <class M>
  void set(const FlagField<M>& field, std::uint32_t at, int) {
    entry_.element.*field.member = number(at).number() != 0;
  }
  template <class M>
  void set(const SideField<M>& field, std::uint32_t at, int) {
    entry_.element.*field.member = static_cast<int>(number(at).number());
  }
  template <class M>
  void set(const ChoiceField<M>& field, std::uint32_t at, int) {
    entry_.element.*field.member = number(at).number() != 0;
  }
  template <class M>
  void set(const CurveField<M>& field, std::uint32_t at, int) {
    const CurveTemplate& curve = builder_.scene().indirect.curves[static_cast<std::size_t>(number(at).number())];
    try {
      const int body = field.body == 0 ? entry_.i : entry_.j;
      entry_.element.*field.member = builder_.curve(curve);
      if (body >= 0) entry_.element.*field.member += builder_.model().bodies[static_cast<std::size_t>(body)].origin;
    } catch (const std::invalid_argument& error) {
      wrong(curve.offset, field.key, std::string("is no curve: ") + error.what());
    }
  }
  template <class M>
  void set(const TableField<M>& field, std::uint32_t at, int) {
    const TableTemplate& table = builder_.scene().indirect.tables[static_cast<std::size_t>(number(at).number())];
    const auto pairs = builder_.table(table);
    for (const auto& pair : pairs) {
      if (std::isnan(value_of(pair.x) + value_of(pair.y))) good_ = false;  // reported where it stands
    }
    if (!good_) return;
    try {
      entry_.element.*field.member = {pairs, table.beyond};
    } catch (const std::invalid_argument& error) {
      wrong(table.offset, field.key, std::string("is no curve: ") + error.what());
    }
  }
  void set(const FunctionField& field, std::uint32_t at, int slot) {
    value_offset_ = number(at).offset();
    value_given_ = true;
    set_function(field.key, field.index, at, slot);
  }
  void set(const FunctionPairField& field, std::uint32_t at, int slot) {
    for (int k = 0; k < 2; ++k) set_function(field.key, field.index + k, at + static_cast<std::uint32_t>(k), slot + k);
  }
  void set_function(std::string_view key, int index, std::uint32_t at, int slot) {
    if constexpr (E::functions > 0) {
      FunctionValue<S>& target = entry_.values[static_cast<std::size_t>(index)];
      if (!((source_.indirect >> slot) & 1)) {
        target.constant = builder_.value(number(at));
        return;
      }
      const auto& function = builder_.scene().indirect.functions[static_cast<std::size_t>(number(at).number())];
      if (function.kind == FunctionTemplate::Kind::state) {
        target.law = builder_.state_law(builder_.scene().state_laws[static_cast<std::size_t>(function.state)]);
        good_ = good_ && target.law >= 0;
        return;
      }
      try {
        const TimeFunction<S> made = builder_.function(function);
        if (made.is_constant()) {
          target.constant = made.evaluate(0.0).f;
        } else {
          target.function = static_cast<int>(builder_.model().functions.size());
          builder_.model().functions.push_back(made);
        }
      } catch (const std::invalid_argument& error) {
        wrong(function.offset, key, std::string("is no function of time: ") + error.what());
      }
    }
  }

  ModelBuilder<S>& builder_;
  const ElementTemplate& source_;
  ElementEntry<E, S>& entry_;
  const Vec2<S>* points_;
  int slot_ = 0, field_ = 0;
  bool good_ = true, value_given_ = false;
  std::size_t value_offset_ = 0;
};

/// The value c of a constraint that the scene leaves out, measured in the given configuration.
template <class E, class S>
void measure_value(ElementEntry<E, S>& entry, const Frame<S>& i, const Frame<S>& j) {
  if constexpr (E::functions == 1 && when_omitted<E>() == Omitted::given) {
    entry.values[0].constant = measure_of(entry.element, i, j, no_contact);
  }
}

/// Whether a measured distance is rounding of the places that it lies between, of four operations each: its line has no
/// direction then, and rank and motion would follow rounding.
template <class E, class S>
bool is_rounding(const ElementEntry<E, S>& entry, const Frame<S>& i, const Frame<S>& j) {
  double size = 0;
  const auto take_in = [&](const S& x, const S& y) {
    size = std::max({size, std::abs(value_of(x)), std::abs(value_of(y))});
  };
  take_in(i.x, i.y);
  take_in(j.x, j.y);
  const auto look = [&](const auto& field) {
    if constexpr (kind_of(std::remove_cvref_t<decltype(field)>{}) == FieldKind::point) {
      const Vec2<S>& point = entry.element.*field.member;
      take_in(point.x, point.y);
    }
  };
  std::apply([&](const auto&... field) { (look(field), ...); }, E::fields());
  return std::abs(value_of(entry.values[0].constant)) <= 4 * std::numeric_limits<double>::epsilon() * size;
}

template <class E, class S>
void fill(ModelBuilder<S>& builder, const ElementTemplate& source, const int* bodies, const Vec2<S>* points) {
  BasicModel<S>& model = builder.model();
  ElementEntry<E, S> entry;
  if constexpr (requires { E::keys(); }) {
    if (!builder.find_column(source, entry)) return;
  } else {
    entry.i = bodies[0];
    entry.j = bodies[1];
  }
  Filler<E, S> filler(builder, source, entry, points);
  bool good = filler.run();
  const auto wrong = [&](std::size_t offset, std::string_view what) {
    good = false;
    if (!builder.known_wrong(offset)) builder.report(offset, builder.owner(source) + ": " + std::string(what));
  };
  if constexpr (requires { entry.element.complete(Frame<S>{}, Frame<S>{}); }) {
    const auto [frame_i, frame_j] = given_frames<E>(model, entry.i, entry.j);
    entry.element.complete(frame_i, frame_j);
  }
  if constexpr (requires { entry.element.check(); }) {
    if (good) {
      const char* problem = entry.element.check();
      if (problem && !source.faulty && !builder.reported(source.offset)) wrong(source.offset, problem);
      good = good && !problem;
    }
  }
  ElementKind kind = source.kind;
  if constexpr (E::functions > 0 && requires { E::rows; }) {
    if (!filler.value_given()) {
      const auto [frame_i, frame_j] = given_frames<E>(model, entry.i, entry.j);
      measure_value<E, S>(entry, frame_i, frame_j);
      if constexpr (HasSquaredValue<E>) {
        if (is_rounding(entry, frame_i, frame_j)) entry.values[0].constant = S(0);
      }
    }
    // A constraint whose value changes with time is a driver, whichever list it is in.
    if (entry.values[0].function >= 0) kind = ElementKind::driver;
    if constexpr (HasSquaredValue<E>) {
      if (entry.values[0].function < 0 && value_of(entry.values[0].constant) <= 0) {
        const bool zero = value_of(entry.values[0].constant) == 0;
        wrong(filler.value_given() ? filler.value_offset() : source.offset,
              zero ? zero_distance : "a distance may not be negative");
      }
    }
  }
  if constexpr (std::is_same_v<E, Cable<S>>) {
    // With a stiffness it is a force.
    if (good && value_of(entry.element.k) > 0) {
      const Cable<S>& cable = entry.element;
      const ElasticCable<S> elastic{cable.s_i, cable.s_j, cable.length, cable.k};
      builder.append(source, ElementEntry<ElasticCable<S>, S>{elastic, entry.i, entry.j}, ElementKind::force);
      return;
    }
  }
  if (!good) return;
  if constexpr (std::is_same_v<E, Rope<S>>) return builder.append_rope(source, entry);
  builder.append(source, entry, kind);
  if constexpr (HasDamping<E>) add_damping(model, entry);
}

}  // namespace filling

template <class S>
ElementFiller<S> element_filler(int type) {
#define CATENA_FILL(Type) , &filling::fill<Type<S>, S>
  static constexpr std::array fillers{ElementFiller<S>(nullptr) CATENA_CONSTRAINTS(CATENA_FILL)
                                          CATENA_FORCES(CATENA_FILL) CATENA_GAPS(CATENA_FILL)};
#undef CATENA_FILL
  return fillers[static_cast<std::size_t>(type) + 1];
}

}  // namespace catena
