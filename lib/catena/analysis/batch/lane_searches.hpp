// Constraints whose point of contact is searched for, in lanes: each is evaluated one lane after the other, as the
// element itself says, and its row joins those that kernels compute in packs (lane_code.hpp).
//
//   Phi, Phi_q, gamma at the frames of a lane      place: s_i, s_j, where the contact was found last
//
// Every lane has its own copy of every such element, and its contact. It searches from the place that belongs to the
// state of the lane, so that a step that is not taken leaves no trace. A row is not a number where its bodies are
// nowhere. Units m, rad.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "catena/analysis/batch/lane_numbers.hpp"
#include "catena/elements/constraints/cam_cam.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// Types of elements, in the order of their lists.
template <class... E>
struct LaneSearchedList {
  template <class T>
  static constexpr bool has = (std::is_same_v<T, E> || ...);
  static constexpr std::size_t types = sizeof...(E);
  using Copies = std::tuple<std::vector<E>...>;
  /// Calls f(std::type_identity<E>) for every type.
  template <class F>
  static void for_each(F&& f) {
    (f(std::type_identity<E>{}), ...);
  }
};
using LaneSearchedElements = LaneSearchedList<PointOnCurve<double>, CamFlat<double>, CamCam<double>>;

/// A row that is searched for, of the list of its type in the model.
struct LaneSearched {
  int row, body_i, body_j;  ///< frames
  int slot[6];              ///< of its entries, x_i ... phi_j
  int entry, element;       ///< in the list of its type; in the model
};

/// Type after type, as in LaneSearchedElements.
struct LaneSearchedTypes {
  std::array<std::vector<LaneSearched>, LaneSearchedElements::types> of_type;

  int count() const {
    std::size_t rows = 0;
    for (const std::vector<LaneSearched>& type : of_type) rows += type.size();
    return static_cast<int>(rows);
  }
};

class LaneSearches {
 public:
  /// `types` must outlive this object; `moving`: how many frames move.
  LaneSearches(const LaneSearchedTypes& types, int moving);

  bool empty() const { return types_.count() == 0; }
  /// Copies the elements of a design, with the places of its given configuration.
  void set_design(int lane, const Model& model);
  /// Places s_i, s_j of element after element, into and out of all lanes.
  void go_to(const LaneNumbers& places);
  void keep_places(LaneNumbers& places) const;
  void keep_places(int lane, LaneNumbers& places) const;
  /// Takes over the places that an evaluator of the design has found, in the order of its model.
  void take_places(std::span<const CurvePlace> found, int lane, LaneNumbers& places) const;
  /// The same the other way round.
  void show_places(const LaneNumbers& places, int lane, std::vector<CurvePlace>& shown) const;
  /// Why a row means nothing at the frames that a lane was solved at, to which it came from other places; nullptr: it
  /// does.
  const char* trouble(const double* frame, const LaneNumbers& from, int lane) const;
  /// What kernels ask for (LaneJob::search).
  static void search(const LaneJob& job, LaneSearch what, int first, int count);

 private:
  /// Calls f(element, code, k) for every element of a lane; k: its place in contacts_.
  template <class F>
  void for_each_of_lane(int lane, F&& f) const;
  template <class E>
  void evaluate(const E& element, const LaneSearched& code, const LaneJob& job, LaneSearch what, int lane,
                CurvePlace& contact) const;

  const LaneSearchedTypes& types_;
  int moving_;
  LaneSearchedElements::Copies copies_;  // element after element, lane_count of each
  std::vector<CurvePlace> contacts_;     // type after type, likewise
};

}  // namespace catena
