// The elements of a stretch of a rope: its straight lines, and what ties its bodies beside them (rope_part.hpp,
// elastic_rope.hpp).
//
//   inextensible   lines; a bridge between bodies that are tied across others which stand still
//   elastic        lines; a bridge for each pair of bodies that no line joins, for its part of g g^T
//
// A rope that may leave pulleys keeps as many elements as it has on all of them: those too many are bridges.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "catena/model/rope_way.hpp"

namespace catena {

template <class S>
struct RopePiece {
  int i = ground, j = ground;
  RopeSpan<S> span{};
  bool bridge = false;
  bool owns_i = false, owns_j = false, owns_pair = false;  ///< see elastic_rope.hpp

  template <class E>
  void give(E& elastic) const {
    static_cast<RopeSpan<S>&>(elastic) = span;
    elastic.bridge = bridge;
    elastic.owns_i = owns_i;
    elastic.owns_j = owns_j;
    elastic.owns_pair = owns_pair;
  }
};

template <class S>
using RopeLines = std::vector<typename RopeStretch<S>::Straight>;

template <class S>
bool moves(const BasicModel<S>& model, int body) {
  return body >= 0 && !model.bodies[static_cast<std::size_t>(body)].fixed;
}

template <class S>
std::vector<RopePiece<S>> inextensible_pieces(const BasicModel<S>& model, const RopeLines<S>& lines) {
  std::vector<RopePiece<S>> pieces, bridges;
  // Bodies that no line joins to those before.
  int known = -1;
  for (const auto& line : lines) {
    pieces.push_back({line.i, line.j, line.span});
    bool joined = known < 0;
    int moving = -1;
    for (const int body : {line.i, line.j}) {
      if (!moves(model, body)) continue;
      joined = joined || body == known;
      moving = body;
    }
    if (!joined) bridges.push_back({.i = known, .j = moving, .bridge = true});
    if (moving >= 0) known = moving;
  }
  pieces.insert(pieces.end(), bridges.begin(), bridges.end());
  return pieces;
}

template <class S>
std::vector<RopePiece<S>> elastic_pieces(const BasicModel<S>& model, const RopeLines<S>& lines) {
  std::vector<RopePiece<S>> pieces;
  std::vector<int> bodies;
  for (const auto& line : lines) {
    pieces.push_back({line.i, line.j, line.span});
    for (const int body : {line.i, line.j}) {
      if (moves(model, body) && std::find(bodies.begin(), bodies.end(), body) == bodies.end()) bodies.push_back(body);
    }
  }
  const auto joins = [](const RopePiece<S>& piece, int a, int b) {
    return (piece.i == a && piece.j == b) || (piece.i == b && piece.j == a);
  };
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const auto here = [&](const RopePiece<S>& piece) { return joins(piece, bodies[a], bodies[b]); };
      if (std::none_of(pieces.begin(), pieces.end(), here))
        pieces.push_back({.i = bodies[b], .j = bodies[a], .bridge = true});
    }
  }
  // Every block of g g^T belongs to the first element that has it.
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    RopePiece<S>& piece = pieces[p];
    const auto earlier = pieces.begin() + static_cast<std::ptrdiff_t>(p);
    const auto is_first = [&](int body) {
      return std::none_of(pieces.begin(), earlier, [&](const auto& e) { return e.i == body || e.j == body; });
    };
    piece.owns_i = is_first(piece.i);
    piece.owns_j = is_first(piece.j);
    piece.owns_pair = std::none_of(pieces.begin(), earlier, [&](const auto& e) { return joins(e, piece.i, piece.j); });
  }
  return pieces;
}

/// The elements of a stretch, as many as on all of its pulleys.
template <class S>
std::vector<RopePiece<S>> padded(const BasicModel<S>& model, const RopeStretch<S>& stretch, bool elastic) {
  const auto pieces_of = [&](const RopeLines<S>& lines) {
    return elastic ? elastic_pieces(model, lines) : inextensible_pieces(model, lines);
  };
  std::vector<RopePiece<S>> pieces = pieces_of(stretch.straight);
  const std::vector<RopePiece<S>> all = pieces_of(stretch.skeleton);
  if (pieces.size() > all.size()) throw ModelError("it passes one body so often that its ways are not followed");
  for (std::size_t k = pieces.size(); k < all.size(); ++k)
    pieces.push_back({.i = all[k].i, .j = all[k].j, .bridge = true});
  return pieces;
}

}  // namespace catena
