// The assembly plan: the structure of a mechanism, which does not depend on its numbers, computed once.
//
//   bodies in plan order: those solved for, then immobile ones, then (frames only) the ground
//   coordinates [x, y, phi] of every body, positions relative to the body's own origin (its given place): differences
//   of large coordinates are then formed once, here, and rounding does not grow with the distance from the ground's
//   columns of Phi_q: the coordinates that are unknown (not those of immobile bodies, not a particle's angle)
//   rows of Phi_q: type after type, element after element
//   slots: where each varying entry of Phi_q goes in the compressed values
//
// Immutable and shareable between threads; a change of parameters keeps it. Linear time: a few microseconds a body.
#pragma once

#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "catena/assembly/constraint_block.hpp"
#include "catena/assembly/force_block.hpp"
#include "catena/assembly/structure/elimination.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"
#include "catena/model/model.hpp"

namespace catena {

namespace detail {
template <class Lists>
struct BlocksOf;
template <class... Elements>
struct BlocksOf<std::tuple<std::vector<ElementEntry<Elements, double>>...>> {
  using Blocks = std::tuple<ConstraintBlock<Elements>...>;
  using Data = std::tuple<ConstraintData<Elements>...>;
  using Forces = std::tuple<ForceBlock<Elements>...>;
  using ForceValues = std::tuple<ForceData<Elements>...>;
};
}  // namespace detail

using ConstraintBlocks = detail::BlocksOf<ConstraintLists<double>>::Blocks;
using ForceBlocks = detail::BlocksOf<ForceLists<double>>::Forces;
using ForceValues = detail::BlocksOf<ForceLists<double>>::ForceValues;
using ConstraintValues = detail::BlocksOf<ConstraintLists<double>>::Data;

struct PlanOptions {
  /// Elements whose reactions are needed: a weld among them is solved for instead of eliminated.
  std::vector<int> keep_elements = {};
  /// Constraints that do not hold for the time being: they get no equations. Bodies are numbered as if they held, so
  /// that plans that differ only in released constraints number bodies alike.
  std::vector<int> released_elements = {};
  /// Whether one-sided elements get equations. If not, models that contain some are refused unless these are released.
  bool one_sided = false;
  /// Whether friction of joints may get rows, where it is not released: only while it sticks, in motion.
  bool friction = false;
};

struct Plan {
  int bodies = 0;       ///< all bodies of the model
  int moving = 0;       ///< plan bodies 0 ... moving - 1 are solved for
  int columns = 0;      ///< unknown coordinates
  int rows = 0;         ///< constraint rows that are solved for
  int driver_rows = 0;  ///< those of drivers
  int islands = 0;
  struct {
    int contacts = 0;  ///< elements that search on curves, with rows or without
    int values = 0;    ///< constraints whose types have functions of time, with rows
    int loads = 0;     ///< functions of time and laws of force elements
  } in_pose;           ///< sizes of what Pose holds

  std::vector<int> plan_body;   ///< of a model body
  std::vector<int> model_body;  ///< of a plan body
  std::vector<int> island;      ///< of a plan body; -1 for immobile ones
  std::vector<int> column;      ///< of a coordinate 3 b + k, or -1
  std::vector<int> coordinate;  ///< of a column
  bool contiguous = true;       ///< column == coordinate for all columns: no particles

  std::vector<int> element_row;  ///< first row of an element of the model's list, -1: none
  std::vector<int>
      element_contact;             ///< of an element of the model's list that searches on curves, its contact; else -1
  std::vector<char> released;      ///< of an element: it does not hold for the time being; empty: none
  std::vector<int> row_element;    ///< element of a row
  std::vector<char> row_is_angle;  ///< residual in radians; else in metres
  std::vector<int> gap_rows;       ///< rows of one-sided elements

  SparsePattern jacobian;  ///< rows x columns
  ConstraintBlocks blocks;
  ForceBlocks forces;
  bool constant_jacobian = true;   ///< no entry of Phi_q varies
  std::vector<char> body_has_row;  ///< per plan body: some constraint touches it
  /// Moving plan bodies that laws of state tie besides: one that a force acts on, and one that its law reads.
  std::vector<std::pair<int, int>> law_pairs;

  bool is_released(int element) const { return !released.empty() && released[static_cast<std::size_t>(element)]; }
  /// Column of entry k of an element's six [x, y, phi of i, of j], where i and j are plan bodies or -1; or -1.
  int column_of(int i, int j, int k) const {
    const int body = k < 3 ? i : j;
    return body >= 0 && body < moving ? column[static_cast<std::size_t>(3 * body + k % 3)] : -1;
  }
  int trash_slot() const { return jacobian.entries(); }  ///< where entries of immobile bodies go
  int coordinates() const { return 3 * (bodies + 1); }   ///< of all bodies and, last and always zero, the ground
  int mobility() const { return columns - (rows - driver_rows); }  ///< Grübler's count

  /// Throws ModelError for one-sided elements that would hold as equations.
  static std::shared_ptr<const Plan> make(const Model& model, const PlanOptions& options = {});
};

}  // namespace catena
