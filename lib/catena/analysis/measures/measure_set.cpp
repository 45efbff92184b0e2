#include "catena/analysis/measures/measure_set.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "catena/analysis/measures/measure_account.hpp"
#include "catena/columns/switches.hpp"

namespace catena {
namespace {

/// The names of all columns, each once; their places in it by request.
struct ColumnPlaces {
  std::vector<std::string> names;
  std::vector<std::array<std::size_t, 2>> of_request;
};

ColumnPlaces places_of(const std::vector<MeasureRequest>& requests) {
  ColumnPlaces places;
  for (const MeasureRequest& request : requests) {
    std::array<std::size_t, 2> own{};
    for (std::size_t k = 0; k < request.columns.size() && k < 2; ++k) {
      const auto known = std::find(places.names.begin(), places.names.end(), request.columns[k]);
      own[k] = static_cast<std::size_t>(known - places.names.begin());
      if (known == places.names.end()) places.names.push_back(request.columns[k]);
    }
    places.of_request.push_back(own);
  }
  return places;
}

}  // namespace

MeasureSet::~MeasureSet() = default;

MeasureSet::MeasureSet(std::vector<MeasureRequest> requests, const Model& model, const Plan& plan,
                       const ColumnSources& sources, const TimeRange& run)
    : run_(run), requests_(std::move(requests)), breakpoints_(model.functions) {
  std::erase_if(requests_, [](const MeasureRequest& request) { return request.kind == MeasureKind::field; });
  if (requests_.empty()) return;
  is_driven_ = sources.analysis != "dynamics";
  resolve(model, plan, sources);
  for (const MeasureRequest& request : requests_) {
    if (needs_time(request.kind) && !sources.timed)
      throw std::invalid_argument(
          fmt::format("measure \"{}\" is taken over time, which {} has not", request.name, sources.analysis));
  }
  open_accounts(places_of(requests_).of_request);
}

void MeasureSet::resolve(const Model& model, const Plan& plan, const ColumnSources& sources) {
  std::vector<std::string> names = places_of(requests_).names;
  ColumnSources untimed = sources;
  untimed.timed = false;
  columns_ = std::make_unique<ColumnSet>(ColumnSet::resolve(model, plan, names, untimed));
  if (!columns_->notes().empty()) throw std::invalid_argument("measures: " + columns_->notes().front());
  if (columns_->size() != names.size()) throw std::invalid_argument("measures: a name stands for more than one column");
  const bool loads_switch = !switches_of_loads(model, {}, true).empty();
  for (std::size_t c = 0; c < columns_->size(); ++c) {
    std::vector<std::string> by = switches_of(model, names[c]);
    if (loads_switch) {
      const bool multipliers = ColumnSet::resolve(model, plan, std::span(&names[c], 1), untimed).needs().multipliers;
      for (std::string& load : switches_of_loads(model, names[c], multipliers)) by.push_back(std::move(load));
    }
    for (const std::string& name : by) {
      const auto known = std::find(names.begin(), names.end(), name);
      switches_.push_back({c, static_cast<std::size_t>(known - names.begin())});
      if (known == names.end()) names.push_back(name);
    }
  }
  if (switches_.empty()) return;
  auto switched = std::make_unique<ColumnSet>(ColumnSet::resolve(model, plan, names, untimed));
  (sources.timed && is_driven_ ? columns_ : switched_columns_) = std::move(switched);
}

void MeasureSet::open_accounts(const std::vector<std::array<std::size_t, 2>>& places) {
  samples_ = std::make_unique<MotionSamples>(*columns_, run_);
  if (!switched_columns_) samples_->switch_columns(switches_);
  if (is_driven_) samples_->follow_places();
  accounts_.clear();
  wants_samples_ = false;
  for (std::size_t k = 0; k < requests_.size(); ++k) {
    accounts_.push_back(std::make_unique<Account>(requests_[k], places[k][0], places[k][1], run_));
    wants_samples_ = wants_samples_ || accounts_.back()->wants_samples();
  }
}

void MeasureSet::begin_again(std::vector<MeasureRequest> requests, const Model& model, const TimeRange& run) {
  run_ = run;
  requests_ = std::move(requests);
  breakpoints_ = Breakpoints(model.functions);
  std::erase_if(requests_, [](const MeasureRequest& request) { return request.kind == MeasureKind::field; });
  if (!requests_.empty()) open_accounts(places_of(requests_).of_request);
  earliest_row_.reset();
  latest_row_.reset();
  end_.reset();
  broken_at_.reset();
  looked_ = true;
}

void MeasureSet::use_values(MotionSamples::Values values) {
  if (samples_) samples_->use_values(std::move(values));
}

void MeasureSet::differentiate(int parameters, DifferentiateColumns derivatives, bool may_end, bool instants_move) {
  if (empty()) return;
  parameters_ = parameters;
  may_end_ = may_end;
  if (switched_columns_) {
    columns_ = std::move(switched_columns_);
    samples_ = std::make_unique<MotionSamples>(*columns_, run_);
    samples_->switch_columns(switches_);
  }
  bool integrals = false;
  for (const auto& account : accounts_) {
    account->set_parameters(parameters, instants_move);
    integrals = integrals || account->is_integral();
  }
  samples_->differentiate(parameters, std::move(derivatives), integrals);
}

void MeasureSet::cover(const MotionStretch& stretch) {
  if (empty()) return;
  double from = stretch.from;
  bool breaks = breakpoints_.contain(from) || from == broken_at_;
  while (from < stretch.to) {
    // A breakpoint that rounding puts beside the end is the end's own.
    double to = std::min(breakpoints_.next(from), stretch.to);
    if (!(stretch.to - to > 1e-12 * std::abs(to))) to = stretch.to;
    const bool ends_phase = to == stretch.to && stretch.ends_phase && parameters_ > 0;
    const bool breaks_after = to < stretch.to || ends_phase || breakpoints_.contain(to);
    cover_piece({{from, to, stretch.at, stretch.expect}, breaks, breaks_after});
    if (ends_phase) broken_at_ = to;
    from = to;
    breaks = breaks_after;
  }
}

void MeasureSet::cover_piece(const MotionPiece& piece) {
  for (const auto& account : accounts_) account->look_at_instants(*samples_, piece);
  if (wants_samples_) {
    looked_ = samples_->cover(piece, [&](const MotionSamples::Part& part, const MotionPiece& within) {
      for (const auto& account : accounts_) account->add(*samples_, part, within);
    }) && looked_;
  }
  if (parameters_ > 0 && (may_end_ || (piece.breaks_after && piece.to() == run_.last))) look_at_end(piece);
}

void MeasureSet::look_at_end(const MotionPiece& piece) {
  end_.reset();
  std::optional<MotionSample> sample =
      piece.breaks_after ? samples_->limit(piece, piece.to(), true) : samples_->look(piece, piece.to(), true);
  std::optional<std::vector<double>> rate = samples_->rates(piece, piece.to());
  if (!sample || !rate) return;
  end_.emplace(End{piece.to(), std::move(*sample), std::move(*rate), {}, {}});
  if (!piece.breaks_after) return;
  end_->moving = samples_->moving(piece.to());
  if (end_->moving.empty()) return;
  if (const std::optional<Snapshot> there = piece.stretch.at(piece.to()))
    end_->change = samples_->take(*there, true).change;
  else
    end_.reset();
}

double MeasureSet::pace() const { return wants_samples_ ? samples_->pace() : 0; }

void MeasureSet::take_row(const Snapshot& snapshot, bool only_rows) {
  if (empty()) return;
  const bool at_end = only_rows || snapshot.t == run_.last || !earliest_row_ || snapshot.t < *earliest_row_;
  note_row(samples_->take(snapshot, parameters_ > 0 && at_end), only_rows);
}

bool MeasureSet::take_row(double t) {
  if (empty()) return true;
  const std::optional<MotionSample> sample = samples_->take_values(t);
  if (sample) note_row(*sample, false);
  return sample.has_value();
}

void MeasureSet::note_row(const MotionSample& sample, bool only_rows) {
  earliest_row_ = std::min(earliest_row_.value_or(sample.t), sample.t);
  latest_row_ = std::max(latest_row_.value_or(sample.t), sample.t);
  for (const auto& account : accounts_) account->add_row(sample, only_rows);
  if (wants_samples_ && !only_rows) samples_->note_row(sample);
}

void MeasureSet::know_accuracy(double part) {
  for (const auto& account : accounts_) account->know_accuracy(part);
}

void MeasureSet::give_pulses() {
  if (samples_) samples_->differentiate_later();
  for (const auto& account : accounts_) account->give_pulses();
}

std::optional<std::vector<std::vector<ColumnPulse>>> MeasureSet::pulses(std::string& why) const {
  std::optional<std::vector<std::vector<ColumnPulse>>> all;
  std::vector<std::vector<ColumnPulse>> pulses(accounts_.size());
  for (std::size_t k = 0; k < accounts_.size(); ++k) {
    const MeasureResult result = accounts_[k]->result({}, looked_);
    const std::string_view more = accounts_[k]->pulses(result, pulses[k]);
    if (more.empty()) continue;
    why = fmt::format("measure \"{}\" {}", requests_[k].name, more);
    return all;
  }
  all = std::move(pulses);
  return all;
}

std::vector<MeasureResult> MeasureSet::results(const MovingInstants* moving,
                                               const std::vector<std::vector<double>>* given) const {
  std::vector<MeasureResult> results;
  for (std::size_t k = 0; k < accounts_.size(); ++k) {
    const auto& names = requests_[k].columns;
    const auto info = std::find_if(columns_->info().begin(), columns_->info().end(),
                                   [&](const ColumnInfo& column) { return column.name == names.front(); });
    const Account& account = *accounts_[k];
    results.push_back(account.result(info == columns_->info().end() ? ColumnInfo{} : *info, looked_));
    if (parameters_ == 0) continue;
    if (given && results.back().value) account.take_given(results.back(), (*given)[k]);
    const End* end = end_ && latest_row_ && end_->t == *latest_row_ ? &*end_ : nullptr;
    results.back().by_last_instant = account.by_last_instant(results.back(), end);
    if (ended_early() && !moving) account.leave_out_early_end(results.back());
    if (moving) account.move(results.back(), end, *moving, k, given);
  }
  return results;
}

}  // namespace catena
