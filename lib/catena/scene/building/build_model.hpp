// Builds the model from a compiled scene and parameter values: expands replicate blocks, resolves names, and takes
// omitted values from the given configuration.
//
// Templated on the scalar of the parameters: with Dual numbers the derivatives run through everything that follows from
// them, local points from a place `at`, the inertia of a rod, spline coefficients, constants taken from the
// configuration. Bodies first, then elements, so that blocks and lists may name each other in any order. Linear time, a
// microsecond or two a link. Every error is reported at its place in the text, in a repeated block for the first k at
// which it occurs.
#pragma once

#include <cstdint>
#include <span>

#include "catena/base/dual.hpp"
#include "catena/scene/reading/scene_template.hpp"

namespace catena {

struct BuildOptions {
  std::int64_t max_elements = 10'000'000;  ///< bodies and elements; a larger scene is refused
};

/// The model; to be used only if nothing was reported. `parameters` in the order of the scene's parameter names.
template <class S>
BasicModel<S> build_model(const SceneTemplate& scene, std::span<const S> parameters, const BuildOptions& options,
                          Diagnostics& diagnostics);

extern template BasicModel<double> build_model(const SceneTemplate&, std::span<const double>, const BuildOptions&,
                                               Diagnostics&);
extern template BasicModel<Dual<double, 4>> build_model(const SceneTemplate&, std::span<const Dual<double, 4>>,
                                                        const BuildOptions&, Diagnostics&);

}  // namespace catena
