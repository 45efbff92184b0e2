#include "catena/scene/element_filler.hpp"
#include "catena/scene/model_builder_impl.hpp"

namespace catena {

template <class S>
BasicModel<S> build_model(const SceneTemplate& scene, std::span<const S> parameters, const BuildOptions& options,
                          Diagnostics& diagnostics) {
  return ModelBuilder<S>(scene, parameters, options, diagnostics).build();
}

template BasicModel<double> build_model(const SceneTemplate&, std::span<const double>, const BuildOptions&,
                                        Diagnostics&);

}  // namespace catena
