#include "catena/analysis/motion/redundant_rows.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/assembly/systems/row_spread.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Each half as far as the one before: at an eighth of the distance the sine of a singular position nearby is 0.01, and
// nothing is learned any more.
constexpr int most_probes = 4;
// Pivot ratios grow with the square of the distance from a singular position: usual is that half a radian away.
constexpr double usual_growth = 25;
// Exchanges are made until the volume would grow by less than this factor.
constexpr double worthwhile = 1.1;
// A choice is made anew when bodies have moved this far, rad or length scales, or when pivots have become half as
// large: directions that turned away from their w by this angle keep nine tenths of the pivot, but another choice may
// be many times as good near a position in which the present one is singular and the mechanism is not. So many solves
// cost less than a step; where there are more directions both must hold.
constexpr double noticeable_move = 0.3, worse = 0.5;
constexpr int few = 16;
// Entries of W below this part of the largest are rounding and do not affect the choice.
constexpr double nothing = 1e-9;

/// W as p columns over the rows, in units in which S has a diagonal of ones, and the direction that belongs to each.
/// Loops of a mechanism are local, and so are columns: only their entries are kept.
class Exchange {
 public:
  Exchange(const Plan& plan, const std::vector<double>& sizes) : sizes_(sizes), element_(at(plan.rows)) {
    for (int r = 0; r < plan.rows; ++r) {
      if (r == 0 || plan.row_element[at(r)] != plan.row_element[at(r - 1)]) first_.push_back(r);
      element_[at(r)] = static_cast<int>(first_.size()) - 1;
    }
    first_.push_back(plan.rows);
  }

  /// w and its direction c, c^T w = 1, as they are.
  void add(std::span<const double> w, std::span<const int> rows, std::span<const double> c) {
    Column column{.w = {}, .direction = {}, .element = element_[at(rows.front())]};
    column.direction.assign(at(first_[at(column.element) + 1] - first_[at(column.element)]), 0.0);
    double square = 0, largest = 0;
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const double x = c[n] / sizes_[at(rows[n])];
      column.direction[at(rows[n] - first_[at(column.element)])] = x;
      square += x * x;
    }
    for (double& x : column.direction) x /= std::sqrt(square);
    for (std::size_t r = 0; r < w.size(); ++r) largest = std::max(largest, std::abs(w[r]) * sizes_[r]);
    for (std::size_t r = 0; r < w.size(); ++r) {
      const double x = w[r] * sizes_[r];
      if (std::abs(x) > nothing * largest) column.w.push_back({static_cast<int>(r), x * std::sqrt(square)});
    }
    find_longest(column);
    columns_.push_back(std::move(column));
  }

  void run() {
    while (true) {
      const auto best = std::max_element(columns_.begin(), columns_.end(),
                                         [](const Column& a, const Column& b) { return a.length < b.length; });
      // Every exchange multiplies the volume by that, so that this ends.
      if (!(best->length > worthwhile) || !std::isfinite(best->length)) return;
      exchange(*best);
    }
  }

  SparseVectors directions() const {
    SparseVectors all;
    for (const Column& column : columns_) {
      for (std::size_t n = 0; n < column.direction.size(); ++n) {
        const int row = first_[at(column.element)] + static_cast<int>(n);
        all.index.push_back(row);
        all.value.push_back(column.direction[n] * sizes_[at(row)]);
      }
      all.start.push_back(static_cast<int>(all.index.size()));
    }
    return all;
  }

 private:
  struct Entry {
    int row;
    double value;
  };
  struct Column {
    std::vector<Entry> w;  // by rows, ascending
    std::vector<double> direction;
    int element;       // of the direction
    int longest = -1;  // the element where w is longest ...
    double length = 0;
  };

  void find_longest(Column& column) const {
    double most = 0, square = 0;
    int element = -1;
    for (const Entry& entry : column.w) {
      if (element_[at(entry.row)] != element) square = 0, element = element_[at(entry.row)];
      square += entry.value * entry.value;
      if (square > most) most = square, column.longest = element;
    }
    column.length = std::sqrt(most);
  }

  // The entries of a column at an element.
  auto at_element(const Column& column, int element) const {
    const auto before = [](const Entry& entry, int row) { return entry.row < row; };
    const auto begin = std::lower_bound(column.w.begin(), column.w.end(), first_[at(element)], before);
    return std::pair(begin, std::lower_bound(begin, column.w.end(), first_[at(element) + 1], before));
  }

  // The direction moves to where its w is longest, along it there; the other columns lose their part along it.
  void exchange(Column& column) {
    const int first = first_[at(column.element = column.longest)], last = first_[at(column.element) + 1];
    column.direction.assign(at(last - first), 0.0);
    const auto [begin, end] = at_element(column, column.element);
    for (auto entry = begin; entry != end; ++entry) column.direction[at(entry->row - first)] = entry->value;
    for (double& x : column.direction) x /= column.length;
    for (Entry& entry : column.w) entry.value /= column.length;
    find_longest(column);
    for (Column& other : columns_) {
      if (&other == &column) continue;
      double product = 0;
      const auto [from, to] = at_element(other, column.element);
      for (auto entry = from; entry != to; ++entry) product += column.direction[at(entry->row - first)] * entry->value;
      if (std::abs(product) > nothing * other.length) subtract(other, product, column);
    }
  }

  void subtract(Column& from, double factor, const Column& column) {
    merged_.clear();
    auto a = from.w.begin();
    for (const Entry& entry : column.w) {
      while (a != from.w.end() && a->row < entry.row) merged_.push_back(*a++);
      double value = -factor * entry.value;
      if (a != from.w.end() && a->row == entry.row) value += (a++)->value;
      if (std::abs(value) > nothing * from.length) merged_.push_back({entry.row, value});
    }
    merged_.insert(merged_.end(), a, from.w.end());
    from.w.swap(merged_);
    find_longest(from);
  }

  const std::vector<double>& sizes_;
  std::vector<int> first_, element_;  // rows of every element, and their end; element by row
  std::vector<Column> columns_;
  std::vector<Entry> merged_;
};

// Whether the pivots of the factors leave no doubt that rows are independent.
bool are_independent(const EquationsOfMotion& equations) {
  const double spread = row_spread(equations.row_sizes(), equations.plan().row_is_angle);
  return equations.smallest_pivot_ratio() >
         std::max(dependence::independent, dependence::rounding_of_pivots * spread * spread);
}

}  // namespace

RedundantRows::RedundantRows(EquationsOfMotion& equations) : equations_(equations), plan_(equations.plan()) {}

std::vector<int> RedundantRows::dependent_rows(std::span<const double> q) {
  Evaluator& evaluator = equations_.evaluator();
  RankOptions options;
  options.most_null_vectors = options.most_dependencies = 0;
  RankReport rank = jacobian_rank(evaluator, plan_.jacobian, jacobian_values(evaluator, q), options);
  if (!rank.ok()) return {};
  // Rows that hold nothing disturb no others, and have no size in which a direction could be measured.
  const std::vector<char> empty = empty_rows(plan_);
  std::erase_if(rank.dependent_rows, [&](int row) { return empty[at(row)]; });
  return std::move(rank.dependent_rows);
}

// Leaves out single equations, at the configuration of the factors.
void RedundantRows::leave_out(const std::vector<int>& rows) {
  const Vector sizes = equations_.row_sizes();
  SparseVectors directions;
  for (int row : rows) {
    directions.index.push_back(row);
    directions.value.push_back(sizes[at(row)]);
    directions.start.push_back(static_cast<int>(directions.index.size()));
  }
  equations_.leave_out(std::move(directions));
}

void RedundantRows::find(std::span<const double> q, const GenericPlace* generic) {
  Evaluator& evaluator = equations_.evaluator();
  const double t = evaluator.time();
  equations_.leave_out({});
  generic_ratio_ = 0;
  if (plan_.rows == 0 || !equations_.factorize(t, Side::after, q)) return;
  if (are_independent(equations_)) return;
  std::vector<int> rows = dependent_rows(q);
  Vector place(q.begin(), q.end()), other(place);
  const auto go_elsewhere = [&] {
    if (!generic) return plan_.columns > plan_.rows - static_cast<int>(rows.size()) && probe(q, other);
    evaluator.set_time(generic->t);
    other = generic->q;
    return true;
  };
  bool start_is_singular = false;
  if (!rows.empty() && go_elsewhere()) {
    std::vector<int> there = dependent_rows(other);
    start_is_singular = there.size() < rows.size();
    if (start_is_singular) {
      rows = std::move(there);
      place = other;
    }
  }
  if (!rows.empty() || start_is_singular) {
    bool factored = equations_.factorize(t, Side::after, place);
    if (!rows.empty()) {
      leave_out(rows);
      factored = equations_.factorize(t, Side::after, place);
    }
    if (factored && start_is_singular) generic_ratio_ = std::min(1.0, usual_growth * equations_.smallest_pivot_ratio());
    if (factored && !rows.empty()) choose();
  }
  chosen_at_.assign(q.begin(), q.end());
  evaluator.set_time(t);
  evaluator.set_configuration(q);
}

void RedundantRows::take_up(SparseVectors directions, std::span<const double> q) {
  equations_.leave_out(std::move(directions));
  chosen_at_.assign(q.begin(), q.end());
}

// A configuration further along the motion that drivers prescribe, with the evaluator at its time; else along a free
// motion with random velocities.
bool RedundantRows::probe(std::span<const double> q, std::span<double> place) {
  Evaluator& evaluator = equations_.evaluator();
  const double length = evaluator.length_scale(), t = evaluator.time();
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto unit = [&](int k) { return k % 3 == 2 ? 1 : length; };
  Assembler assembler(evaluator);
  Vector move(q.size());
  chosen_at_.assign(q.begin(), q.end());
  double distance = probe_distance;
  for (int trial = 0; trial < most_probes; ++trial, distance /= 2) {
    equations_.factorize(t, Side::after, q);
    std::fill(move.begin(), move.end(), 0.0);
    const bool driven = equations_.project_velocity(move, 0) > 0;
    if (!driven) {
      for (int k : plan_.coordinate) move[at(k)] = uniform(generator) * unit(k);
      equations_.remove_forbidden(std::span(move).first(at(3 * plan_.moving)));
    }
    double size = 0;
    for (int k : plan_.coordinate) size = std::max(size, std::abs(move[at(k)]) / unit(k));
    if (!(size > 0)) continue;
    for (std::size_t k = 0; k < place.size(); ++k) place[k] = q[k] + distance / size * move[k];
    if (driven) evaluator.set_time(t + distance / size);
    const bool found = assembler.assemble(place).ok() && moved(place) > distance / 2 && moved(place) < 4 * distance;
    if (found) return true;
    evaluator.set_time(t);
  }
  return false;
}

double RedundantRows::moved(std::span<const double> q) const {
  const double length = equations_.evaluator().length_scale();
  double largest = 0;
  for (int k : plan_.coordinate) {
    largest = std::max(largest, std::abs(q[at(k)] - chosen_at_[at(k)]) / (k % 3 == 2 ? 1 : length));
  }
  return largest;
}

void RedundantRows::follow(std::span<const double> q) {
  if (count() == 0 || equations_.is_singular()) return;
  const double ratio = equations_.smallest_pivot_ratio();
  usual_ratio_ = std::max(usual_ratio_, ratio);
  const bool fell = ratio<worse * usual_ratio_, far = moved(q)> noticeable_move;
  if (count() > few ? !(fell && far) : !(fell || far)) return;
  chosen_at_.assign(q.begin(), q.end());
  usual_ratio_ = 0;
  choose();
}

// Directions at the configuration of the factors.
void RedundantRows::choose() {
  ++choices_;
  const Vector sizes = equations_.row_sizes();
  const SparseVectors& directions = equations_.left_out();
  Exchange exchange(plan_, sizes);
  Vector w(at(plan_.rows));
  for (int k = 0; k < count(); ++k) {
    std::fill(w.begin(), w.end(), 0.0);
    for (int n = directions.start[at(k)]; n < directions.start[at(k) + 1]; ++n) {
      w[at(directions.index[at(n)])] = directions.value[at(n)];
    }
    equations_.solve_rows(w);
    exchange.add(w, directions.indices(k), directions.values(k));
  }
  exchange.run();
  equations_.leave_out(exchange.directions());
}

}  // namespace catena
