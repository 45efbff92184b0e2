// The given poses of an element's bodies, as its complete() and measure() need them.
//
// Elements between two bodies see differences of positions alone: both poses are given from the place of one of the
// bodies, so that values taken from the given configuration are as exact a million metres from the ground's origin as
// next to it. Absolute elements measure in the ground frame. Units: m, rad.
#pragma once

#include <array>

#include "catena/model/model.hpp"

namespace catena {

template <class E, class S>
std::array<Frame<S>, 2> given_frames(const BasicModel<S>& model, int i, int j) {
  std::array<Frame<S>, 2> frames = {model.frame(i), model.frame(j)};
  if constexpr (E::bodies == 2) {
    const Vec2<S> origin = frames[i < 0 ? 1 : 0].origin();
    for (Frame<S>& f : frames) {
      f.x = f.x - origin.x;
      f.y = f.y - origin.y;
    }
  }
  return frames;
}

}  // namespace catena
