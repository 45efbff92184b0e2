// The order of bodies in memory: neighbours near each other, so that evaluation and factors stay in cache.
//
// The given order is kept where it is already local (a chain written link by link); else bodies are numbered breadth
// first from a body of least degree, which is what Cuthill and McKee do. Bodies that are not solved for come last.
#pragma once

#include <span>
#include <vector>

namespace catena {

/// A pair of bodies tied by an element.
struct BodyPair {
  int i, j;
};

/// Order of `bodies` bodies: place k holds body result[k]. `immobile[b]` puts body b at the end. Linear time.
std::vector<int> number_bodies(int bodies, std::span<const BodyPair> ties, const std::vector<char>& immobile);

/// Island of every body: bodies tied directly or through others share a number, 0 ... count - 1 in body order; immobile
/// bodies tie nothing together and get -1.
std::vector<int> find_islands(int bodies, std::span<const BodyPair> ties, const std::vector<char>& immobile,
                              int* count);

}  // namespace catena
