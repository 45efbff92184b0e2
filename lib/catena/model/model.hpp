// A mechanism as plain values: gravity, bodies, points, elements, functions of time. Built by the scene reader or by
// hand; analyses take a copy and never change it.
//
// Templated on the scalar S of its parameters: BasicModel<double> is analysed, BasicModel<Dual> carries derivatives
// with respect to design parameters through everything that was derived from them. Units SI, radians.
// Errors: every add_... throws ModelError, naming the body or element at fault. Adding elements is in model_add.hpp.
#pragma once

#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "catena/base/frame.hpp"
#include "catena/base/time_function.hpp"
#include "catena/model/element_lists.hpp"
#include "catena/model/name_table.hpp"
#include "catena/model/own_column.hpp"
#include "catena/model/rope_path.hpp"
#include "catena/model/state_law.hpp"

namespace catena {

/// An invalid model; what() names the body or element at fault.
class ModelError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// `gap`: a one-sided constraint (gap_element.hpp), stored among the constraints.
enum class ElementKind : unsigned char { constraint, driver, force, gap };

/// Where an element is stored, in file order.
struct ElementRecord {
  ElementKind kind;
  short type;   ///< position in the list of force types or of constraint types (drivers are constraints)
  int index;    ///< position in the vector of its type
  int name;     ///< number in the name table, -1: unnamed
  int ordinal;  ///< n of `type#n`, counted from 1 per type in file order
};

template <class S>
class BasicModel {
 public:
  // Defined where the element types are complete; here they are only declared.
  BasicModel();
  BasicModel(const BasicModel&);
  BasicModel(BasicModel&&) noexcept;
  BasicModel& operator=(const BasicModel&);
  BasicModel& operator=(BasicModel&&) noexcept;
  ~BasicModel();

  Vec2<S> gravity{};
  std::vector<BasicBody<S>> bodies;
  std::vector<BasicPoint<S>> points;
  int first_ground_point = -1;
  ConstraintLists<S> constraints;
  ForceLists<S> forces;
  std::vector<TimeFunction<S>> functions;
  std::vector<BodyShape> shapes;        ///< what bodies look like in figures
  std::vector<RopePath> rope_paths;     ///< where ropes run in figures, in the order of their elements
  std::vector<ElementRecord> elements;  ///< file order
  NameTable names;                      ///< of bodies, constraints, drivers, forces
  NameTable point_names;
  std::vector<int> name_target;  ///< per name: body b >= 0, or -2 - (number in `elements`)
  std::vector<OwnColumn<S>> own_columns;
  std::vector<StateLaw<S>> laws;  ///< of forces

  /// New body; its number is returned. The frame's origin is put at `position`.
  int add_body(std::string_view name, const BodyValues& values);
  /// Takes over a body that is already centroidal; `name` and `first_point` are set here.
  int append_body(std::string_view name, const BasicBody<S>& body);
  /// A named point at `local`, in the author's frame of the body (or the ground frame).
  void add_point(int body, std::string_view name, const Vec2<S>& local);
  /// Local coordinates (centroidal frame) of a named point, or nullptr.
  const Vec2<S>* find_point(int body, std::string_view name) const;

  /// New constraint; local points and axes are given in the authors' frames of the bodies. An empty name leaves it
  /// unnamed. Values that the element can take from the given configuration (its value c, an angle) are taken from it.
  template <class E>
  int add(std::string_view name, const E& element, int i, int j = ground);
  /// The same with a value c for the equation.
  template <class E>
  int add(std::string_view name, const E& element, int i, int j, const S& value);
  /// A scalar constraint whose value is a function of time.
  template <class E>
  int add_driver(std::string_view name, const E& element, int i, int j, const TimeFunction<S>& value);

  /// A force element and its functions of time, in the order of its fields; those left out are zero.
  template <class E>
  int add_force(std::string_view name, const E& element, int i, int j = ground,
                std::initializer_list<TimeFunction<S>> values = {});

  /// Appends an element that is already complete (centroidal coordinates, values set); its record is made here.
  template <class E>
  int append(std::string_view name, const ElementEntry<E, S>& entry, ElementKind kind);

  // An index of no body (`ground` included) or of no element throws std::out_of_range, with the number there is.

  /// The given pose of a body's centroid; of the ground for `ground`.
  Frame<S> frame(int body) const;
  std::string_view body_name(int body) const {
    require_body(body);
    return body < 0 ? "ground" : names[bodies[static_cast<std::size_t>(body)].name];
  }
  /// The element's name, `type#n` if it has none.
  std::string element_name(int element) const;
  std::string_view element_type(int element) const;
  /// The one-sided elements, and the friction of joints, file order.
  std::vector<int> gaps() const;
  std::vector<int> frictions() const;
  /// Number of the body or -2; of the element or -1.
  int find_body(std::string_view name) const;
  int find_element(std::string_view name) const;
  /// Number of the own column of this name, or -1.
  int find_own_column(std::string_view name) const;

 private:
  void require_body(int body) const {
    if (body < ground || body >= static_cast<int>(bodies.size())) refuse_number("body", body, bodies.size());
  }
  void require_element(int element) const {
    if (element < 0 || element >= static_cast<int>(elements.size())) refuse_number("element", element, elements.size());
  }
  [[noreturn]] static void refuse_number(std::string_view what, int number, std::size_t count);
  int claim_name(std::string_view name, int target);
  template <class E>
  ElementEntry<E, S> place(const E& element, int i, int j) const;
  std::vector<int> constraint_count_, force_count_;  // per type: elements so far, for `type#n`
};

using Model = BasicModel<double>;

/// The model given to an analysis; std::invalid_argument for a null pointer.
const Model& required(const std::shared_ptr<const Model>& model);

extern template class BasicModel<double>;
extern template class BasicModel<Dual<double, 4>>;

}  // namespace catena
