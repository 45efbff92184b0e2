#include "catena/analysis/spectrum/circulatory_words.hpp"

#include <fmt/format.h>

#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"

namespace catena {

std::vector<std::string> free_bodies_of(StaticSystem& system, std::span<const double> lambda,
                                        const CirculatoryModes& found) {
  std::vector<std::vector<double>> free;
  for (const CirculatoryMode& mode : found.modes) {
    if (!mode.is_pair() && mode.omega2 == 0) free.push_back(mode.shape);
  }
  return names_of_moving(system, lambda, free);
}

std::vector<std::string> describe_motions(const StaticSystem& system, const Evaluator& evaluator,
                                          const CirculatoryModes& found, const std::vector<std::string>& free_bodies) {
  std::vector<std::string> sentences;
  const CirculatoryMode *lowest = nullptr, *fastest = nullptr;
  for (const CirculatoryMode& mode : found.modes) {
    if (mode.is_pair() && (!fastest || mode.growth() > fastest->growth())) fastest = &mode;
    if (!mode.is_pair() && mode.omega2 < 0 && !lowest) lowest = &mode;
  }
  if (found.neutral > 0) {
    sentences.push_back(
        fmt::format("free to second order, with omega2 = 0: {}", describe_free_motions(found.neutral, free_bodies)));
  }
  if (lowest) {
    sentences.push_back(fmt::format("unstable: {} mode{} with a negative omega2, the lowest: {}", found.negative,
                                    found.negative > 1 ? "s" : "",
                                    describe_mode(evaluator, lowest->shape, system.radius())));
  }
  if (fastest) {
    sentences.push_back(fmt::format(
        "unstable by flutter: {} pair{} of complex omega2, the one that grows fastest by {:.6g} 1/s at {:.6g} rad/s: "
        "{}",
        found.pairs, found.pairs > 1 ? "s" : "", fastest->growth(), fastest->frequency(),
        describe_mode(evaluator, fastest->shape, system.radius())));
  }
  return sentences;
}

}  // namespace catena
