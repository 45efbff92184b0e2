#include "catena/analysis/batch/lane_searches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/base/at.hpp"
#include "catena/elements/curve_search.hpp"

namespace catena {
namespace {

/// Of a lane.
Frame<double> frame_of(const double* frames, int body, int lane) {
  const double* const f = frames + 5 * lane_count * body + lane;
  return {f[0], f[lane_count], f[2 * lane_count], f[3 * lane_count], f[4 * lane_count]};
}

bool is_somewhere(const Frame<double>& f) { return std::isfinite(f.x + f.y + f.c + f.s); }

Frame<Taylor<double>> moving_frame(const Frame<double>& frame, const double* qd, int lane) {
  const double none = 0;
  if (!qd) return moving(frame, none, none, none);
  return moving(frame, qd[lane], qd[lane_count + lane], qd[2 * lane_count + lane]);
}

// Half of the longest step of a search: a contact that moves further at once may have been found anew at another
// place. Steps are halved until it moves less; one that jumps always moves as far.
constexpr double longest_move = longest_search_step / 2;

bool is_far(const BodyCurve<double>& curve, double from, double to) {
  const double range = curve.range(), moved = std::abs(to - from);
  return (curve.shape().periodic() ? std::min(moved, std::abs(range - moved)) : moved) > longest_move * range;
}

template <class E>
bool has_jumped(const E& element, const CurvePlace& from, const CurvePlace& place) {
  if constexpr (requires { element.curve_j; }) {
    return is_far(element.curve_i, from.s_i, place.s_i) || is_far(element.curve_j, from.s_j, place.s_j);
  } else {
    return is_far(element.curve, from.s_i, place.s_i);
  }
}

}  // namespace

LaneSearches::LaneSearches(const LaneSearchedTypes& types, int moving) : types_(types), moving_(moving) {
  std::size_t type = 0;
  std::apply([&](auto&... list) { (list.resize(at(lane_count) * types_.of_type[type++].size()), ...); }, copies_);
  contacts_.resize(at(lane_count * types_.count()));
}

template <class F>
void LaneSearches::for_each_of_lane(int lane, F&& f) const {
  std::size_t type = 0, number = at(lane);
  const auto visit = [&](const auto& list) {
    std::size_t place = at(lane);
    for (const LaneSearched& code : types_.of_type[type++]) {
      f(list[place], code, number);
      place += at(lane_count);
      number += at(lane_count);
    }
  };
  std::apply([&](const auto&... list) { (visit(list), ...); }, copies_);
}

void LaneSearches::set_design(int lane, const Model& model) {
  std::size_t type = 0;
  const auto copy = [&](auto& list) {
    using E = typename std::remove_cvref_t<decltype(list)>::value_type;
    const auto& entries = std::get<std::vector<ElementEntry<E, double>>>(model.constraints);
    std::size_t place = at(lane);
    for (const LaneSearched& code : types_.of_type[type]) {
      list[place] = entries[at(code.entry)].element;
      place += at(lane_count);
    }
    ++type;
  };
  std::apply([&](auto&... list) { (copy(list), ...); }, copies_);
  for_each_of_lane(lane,
                   [&](const auto& element, const LaneSearched&, std::size_t k) { contacts_[k] = element.place(); });
}

void LaneSearches::go_to(const LaneNumbers& places) {
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    const int number = 2 * static_cast<int>(k / at(lane_count));
    contacts_[k] = {-1, places[number][k % at(lane_count)], places[number + 1][k % at(lane_count)]};
  }
}

void LaneSearches::keep_places(int lane, LaneNumbers& places) const {
  int number = 0;
  for (std::size_t k = at(lane); k < contacts_.size(); k += at(lane_count), number += 2) {
    places[number][lane] = contacts_[k].s_i;
    places[number + 1][lane] = contacts_[k].s_j;
  }
}

void LaneSearches::keep_places(LaneNumbers& places) const {
  for (int lane = 0; lane < lane_count; ++lane) keep_places(lane, places);
}

void LaneSearches::take_places(std::span<const CurvePlace> found, int lane, LaneNumbers& places) const {
  int number = 0;
  for_each_of_lane(lane, [&](const auto&, const LaneSearched& code, std::size_t) {
    for (const CurvePlace& place : found) {
      if (place.element != code.element) continue;
      places[number][lane] = place.s_i;
      places[number + 1][lane] = place.s_j;
    }
    number += 2;
  });
}

void LaneSearches::show_places(const LaneNumbers& places, int lane, std::vector<CurvePlace>& shown) const {
  shown.clear();
  int number = 0;
  for_each_of_lane(lane, [&](const auto&, const LaneSearched& code, std::size_t) {
    shown.push_back({code.element, places[number][lane], places[number + 1][lane]});
    number += 2;
  });
}

const char* LaneSearches::trouble(const double* frame, const LaneNumbers& from, int lane) const {
  const char* found = nullptr;
  int number = 0;
  for_each_of_lane(lane, [&](const auto& element, const LaneSearched& code, std::size_t k) {
    const Frame<double> i = frame_of(frame, code.body_i, lane), j = frame_of(frame, code.body_j, lane);
    if (!is_somewhere(i) || !is_somewhere(j) || element.trouble(Arguments<double>{i, j, 0, {}, &contacts_[k]}))
      found = "a contact of curves is undefined";
    else if (has_jumped(element, {-1, from[number][lane], from[number + 1][lane]}, contacts_[k]))
      found = "a contact of curves jumps";
    number += 2;
  });
  return found;
}

template <class E>
void LaneSearches::evaluate(const E& element, const LaneSearched& code, const LaneJob& job, LaneSearch what, int lane,
                            CurvePlace& contact) const {
  double& row = job.right[lane_count * code.row + lane];
  const Frame<double> i = frame_of(job.frame, code.body_i, lane), j = frame_of(job.frame, code.body_j, lane);
  if (!is_somewhere(i) || !is_somewhere(j)) {
    row = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  // At the frames of the residual before.
  if (what == LaneSearch::gamma) {
    const auto rates = [&](int body) { return body < moving_ ? job.qd + 3 * lane_count * body : nullptr; };
    const auto moving_i = moving_frame(i, rates(code.body_i), lane),
               moving_j = moving_frame(j, rates(code.body_j), lane);
    Taylor<double> phi;
    element.phi(Arguments<Taylor<double>>{moving_i, moving_j, {}, {}, &contact}, &phi);
    row = -phi.dd;
    return;
  }
  element.follow_contact(i, j, contact);
  const Arguments<double> a{i, j, 0, {}, &contact};
  element.phi(a, &row);
  if (what == LaneSearch::residual) return;
  double entries[6];
  element.jacobian(a, entries);
  for (int k = 0; k < 6; ++k) job.matrix[lane_count * code.slot[k] + lane] = entries[k];
}

void LaneSearches::search(const LaneJob& job, LaneSearch what, int first, int count) {
  LaneSearches& searches = *job.searches;
  for (int lane = first; lane < first + count; ++lane) {
    searches.for_each_of_lane(lane, [&](const auto& element, const LaneSearched& code, std::size_t k) {
      searches.evaluate(element, code, job, what, lane, searches.contacts_[k]);
    });
  }
}

}  // namespace catena
