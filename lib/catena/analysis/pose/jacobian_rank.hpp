// Rank of the constraint Jacobian, independent of the units of the scene.
//
//   Phi_q D y = ...,   D = length scale on the columns of x and y, 1 on those of angles
//
// The rank analysis (rank_revealing.hpp) scales rows and columns towards length one in a bounded number of passes, and
// then judges which rows are nearly dependent. With coordinates in metres the outcome would depend on the size of the
// machine; with displacements in length scales, machines that differ in size alone have the same matrix.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/linalg/rank/rank_revealing.hpp"

namespace catena {

/// The entries of Phi_q (plan.jacobian) at q, plan order, and the evaluator's time, which it leaves there.
std::vector<double> jacobian_values(Evaluator& evaluator, std::span<const double> q);

/// Rank of rows of Phi_q: `pattern` has all its columns, values are those in SI units, and so are the null vectors.
RankReport jacobian_rank(const Evaluator& evaluator, const SparsePattern& pattern, std::span<const double> values,
                         const RankOptions& options = {});

/// By row, whether it holds nothing: all its bodies are immobile, so that no entry of the Jacobian is its own.
std::vector<char> empty_rows(const Plan& plan);
/// The number of the others.
int acting_rows(const Plan& plan);

}  // namespace catena
