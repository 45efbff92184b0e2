#include "catena/analysis/contact/problem/same_slides.hpp"

#include <algorithm>
#include <cmath>

namespace catena {

bool is_sticking_joint(const ContactProblem& problem, std::size_t a) {
  const ContactProblem::Place& place = problem.place[a];
  return !place.has_normal && place.head < 0 && problem.state[a] == ContactProblem::State::sticks;
}

bool slide_as_one(const ContactProblem& problem, std::size_t a, std::size_t b) {
  const std::size_t r = 2 * a + 1, c = 2 * b + 1;
  const double both = problem.D(r, r) * problem.D(c, c);
  return both > 0 && problem.D(r, c) * problem.D(r, c) >= (1 - ContactProblem::rounding_of_sums) * both;
}

std::vector<SameSlide> same_slides(const ContactProblem& problem) {
  std::vector<SameSlide> slides;
  const auto D = [&](std::size_t a, std::size_t b) { return problem.D(2 * a + 1, 2 * b + 1); };
  for (std::size_t a = 0; a < problem.place.size(); ++a) {
    if (!is_sticking_joint(problem, a)) continue;
    const auto found = std::find_if(slides.begin(), slides.end(), [&](const SameSlide& slide) {
      return slide_as_one(problem, a, slide.places.front());
    });
    if (found == slides.end()) {
      slides.push_back({{a}, {1}});
    } else {
      const std::size_t m = found->places.front();
      found->places.push_back(a);
      found->ratios.push_back(D(a, m) / D(m, m));
    }
  }
  return slides;
}

void share_by_limits(ContactProblem& problem) {
  for (const SameSlide& slide : same_slides(problem)) {
    double held = 0, most = 0;
    for (std::size_t n = 0; n < slide.places.size(); ++n) {
      held += slide.ratios[n] * problem.x[2 * slide.places[n] + 1];
      most += std::abs(slide.ratios[n]) * problem.place[slide.places[n]].limit;
    }
    if (slide.places.size() < 2 || !(most > 0) || !std::isfinite(most)) continue;
    for (std::size_t n = 0; n < slide.places.size(); ++n)
      problem.x[2 * slide.places[n] + 1] =
          held / most * std::copysign(problem.place[slide.places[n]].limit, slide.ratios[n]);
  }
}

}  // namespace catena
