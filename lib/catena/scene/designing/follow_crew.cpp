// A follower's side of a sweep that several processes share.
#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "catena/scene/designing/crew_messages.hpp"
#include "catena/scene/designing/sweep_crew.hpp"

namespace catena {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

class Follower {
 public:
  Follower(ProcessLink& link, const std::function<SweepRecord::Design(std::int64_t k)>& analyse, const CrewTerms& terms)
      : link_(link), analyse_(analyse), terms_(terms) {}

  void run(int threads, const std::function<bool()>& cancelled);

 private:
  void work();
  void hear(const std::string& message);
  void report();
  void end();

  ProcessLink& link_;
  const std::function<SweepRecord::Design(std::int64_t k)>& analyse_;
  const CrewTerms& terms_;
  Clock::time_point heard_ = Clock::now(), said_ = Clock::now();
  bool stop_ = false;
  // Shared by the threads, behind the mutex.
  std::mutex mutex_;
  std::condition_variable some_;
  std::deque<std::int64_t> designs_;
  std::vector<std::pair<std::int64_t, SweepRecord::Design>> finished_;
  std::exception_ptr trouble_;
  int busy_ = 0;
  bool ended_ = false;
};

void Follower::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    some_.wait(lock, [&] { return ended_ || !designs_.empty(); });
    if (ended_) return;
    const std::int64_t k = designs_.front();
    designs_.pop_front();
    ++busy_;
    lock.unlock();
    try {
      SweepRecord::Design design = analyse_(k);
      lock.lock();
      finished_.emplace_back(k, std::move(design));
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      trouble_ = std::current_exception();
    }
    --busy_;
  }
}

void Follower::hear(const std::string& message) {
  CrewReader reader(message);
  const auto word = reader.get<CrewWord>();
  if (reader.get<int>() != terms_.sweep) return;
  heard_ = Clock::now();
  if (word == CrewWord::stop || word == CrewWord::stop_with_loss) {
    stop_ = true;
    if (word == CrewWord::stop_with_loss) link_.told_of_loss();
  }
  if (word != CrewWord::designs) return;
  const std::lock_guard lock(mutex_);
  while (!reader.at_end()) designs_.push_back(reader.get<std::int64_t>());
  some_.notify_all();
}

// What is finished goes out when there is nothing else to do, or twenty times a second.
void Follower::report() {
  const Seconds since = Clock::now() - said_;
  std::vector<std::pair<std::int64_t, SweepRecord::Design>> finished;
  {
    const std::lock_guard lock(mutex_);
    const bool idle = designs_.empty() && busy_ == 0;
    if (idle || since.count() > 0.05) finished.swap(finished_);
  }
  if (finished.empty() && since.count() < 0.5) return;
  said_ = Clock::now();
  CrewWriter message(finished.empty() ? CrewWord::alive : CrewWord::results, terms_.sweep);
  for (const auto& [k, design] : finished) message.put(k, design);
  link_.send(0, message.take());
}

void Follower::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  some_.notify_all();
}

void Follower::run(int threads, const std::function<bool()>& cancelled) {
  CrewWriter hello(CrewWord::hello, terms_.sweep);
  hello.put(terms_.owner);
  link_.send(0, hello.take());
  std::vector<std::jthread> workers;
  for (int n = 0; n < threads; ++n) workers.emplace_back([this] { work(); });
  bool lost = false;
  while (!stop_ && !cancelled() && !lost) {
    bool any = false;
    int from = 0;
    for (std::string message; link_.receive(from, message); any = true) hear(message);
    report();
    lost = Seconds(Clock::now() - heard_).count() > 3 * terms_.patience;
    {
      const std::lock_guard lock(mutex_);
      if (trouble_) break;
    }
    if (!any) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  end();
  workers.clear();
  if (trouble_) std::rethrow_exception(trouble_);
  if (lost) {
    link_.told_of_loss();
    throw std::runtime_error(fmt::format("process {}: the process that leads the sweep has not been heard of for {} s",
                                         link_.rank(), 3 * terms_.patience));
  }
}

}  // namespace

void follow_crew(ProcessLink& link, const std::function<SweepRecord::Design(std::int64_t k)>& analyse, int threads,
                 const std::function<bool()>& cancelled, const CrewTerms& terms) {
  Follower(link, analyse, terms).run(threads, cancelled);
}

}  // namespace catena
