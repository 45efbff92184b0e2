// Sweep: designs are dealt out to threads and processes, and their rows given in order.
#include <thread>

#include "catena/scene/designing/sweep.hpp"
#include "catena/scene/designing/sweep_crew.hpp"

namespace catena {

// Designs that were lost are taken first, however many rows wait: for them, it may be.
bool Sweep::may_take() const { return !again_.empty() || (next_ < count_ && waiting_.size() < most_waiting_); }

std::int64_t Sweep::next() {
  if (again_.empty()) return next_++;
  const std::int64_t k = again_.front();
  again_.pop_front();
  return k;
}

bool Sweep::take_next(std::int64_t& first, int& count) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] { return ended() || may_take(); });
  if (ended()) return false;
  first = next();
  // Several at once only where none can be lost: they stand side by side.
  count = static_cast<int>(std::min<std::int64_t>(count, count_ - first));
  if (count > 1) next_ += count - 1;
  return true;
}

void Sweep::give(std::int64_t k, SweptDesign design) {
  // One that was stopped on the way is not done.
  const bool is_done = design.status != Status::cancelled || !cancelled();
  // One that was lost may come from two processes after all.
  const auto is_new = [&] { return is_done && k >= given_ && !waiting_.contains(k); };
  std::unique_lock lock(mutex_);
  if (SweepRecord* record = context_.sweep.record; record && is_new() && !design.is_recorded) {
    lock.unlock();
    record->add(context_.sweep.analysis, k + 1, design);
    lock.lock();
  }
  if (is_new()) waiting_.emplace(k, std::move(design));
  for (auto first = waiting_.begin(); first != waiting_.end() && first->first == given_ && !stopped_;
       first = waiting_.begin()) {
    SweptDesign& one = first->second;
    if (one.status != Status::ok) {
      ++failed_[std::string(to_string(one.status))];
      failures_->add(given_, one.status, one.message);
    }
    if (scatter_ && one.status == Status::ok) scatter_->add(one.measures);
    const std::vector<double> row = row_of(given_, one);
    if (one.seen) show(given_, row, one);
    if (!context_.rows.row(row)) stopped_ = true;
    waiting_.erase(first);
    ++given_;
    if (context_.progress) context_.progress(static_cast<double>(given_) / static_cast<double>(count_));
  }
  if (cancelled() && given_ < count_) stopped_ = true;
  room_.notify_all();
}

void Sweep::work() {
  try {
    std::string why_not;
    const std::unique_ptr<LaneDesigns> lanes = context_.sweep.link ? nullptr : LaneDesigns::make(context_, why_not);
    if (lanes) {
      work_in_lanes(*lanes);
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      no_lanes_ = why_not;
    }
    std::int64_t k = 0;
    for (int count = 1; take_next(k, count);) give(k, analyse(k));
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!trouble_) trouble_ = std::current_exception();
    stopped_ = true;
    room_.notify_all();
  }
}

// What another process found. A design that is drawn is analysed here once more, unless it was refused: by the scene,
// or because processes ended while they had it.
void Sweep::give_foreign(std::int64_t k, SweepRecord::Design found) {
  if (found.status == Status::cancelled) {
    // That process alone was told to end: another one analyses the design.
    const std::lock_guard lock(mutex_);
    again_.push_back(k);
    room_.notify_all();
    return;
  }
  SweptDesign design;
  if (context_.poses && found.status != Status::refused) design.seen = context_.poses->watch_design(k, count_);
  if (design.seen) {
    design = analyse(k);
  } else {
    static_cast<SweepRecord::Design&>(design) = std::move(found);
  }
  give(k, std::move(design));
}

void Sweep::lead() {
  const SweepRecord* record = context_.sweep.record;
  const CrewDesk desk{.take =
                          [&](std::int64_t& k) {
                            for (;;) {
                              {
                                const std::lock_guard lock(mutex_);
                                if (ended() || !may_take()) return false;
                                k = next();
                              }
                              if (!record || !record->find(context_.sweep.analysis, k + 1, measures_)) return true;
                              give(k, analyse(k));
                            }
                          },
                      .give = [&](std::int64_t k, auto found) { give_foreign(k, std::move(found)); },
                      .put_back =
                          [&](std::int64_t k) {
                            const std::lock_guard lock(mutex_);
                            again_.push_back(k);
                            room_.notify_all();
                          },
                      .done =
                          [&] {
                            const std::lock_guard lock(mutex_);
                            stopped_ = stopped_ || (cancelled() && given_ < count_);
                            if (ended()) room_.notify_all();
                            return ended();
                          }};
  troubles_ =
      lead_crew(*context_.sweep.link, desk, {context_.sweep.analysis, context_.sweep.owner, context_.sweep.patience});
}

void Sweep::follow(int threads) {
  const auto analyse_one = [&](std::int64_t k) -> SweepRecord::Design { return analyse(k); };
  follow_crew(*context_.sweep.link, analyse_one, threads, [&] { return cancelled(); },
              {context_.sweep.analysis, context_.sweep.owner, context_.sweep.patience});
}

std::int64_t Sweep::run(int threads) {
  if (follows()) return follow(threads), 0;
  std::vector<std::jthread> others;
  for (int n = leads() ? 0 : 1; n < threads; ++n) others.emplace_back([this] { work(); });
  if (leads()) {
    try {
      lead();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!trouble_) trouble_ = std::current_exception();
      stopped_ = true;
      room_.notify_all();
    }
  } else {
    work();
  }
  others.clear();
  if (trouble_) std::rethrow_exception(trouble_);
  return given_;
}

}  // namespace catena
