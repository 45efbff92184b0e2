// Processes that share a sweep, here threads that pass messages through memory: the same designs whichever computes
// them, and none is lost with a process that falls silent.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

#include "catena/scene/designing/design_ranges.hpp"
#include "catena/scene/designing/sweep_crew.hpp"

namespace catena::testing {
namespace {

class Mail {
 public:
  explicit Mail(int size) : boxes_(static_cast<std::size_t>(size)) {}
  void send(int from, int to, std::string text) {
    const std::lock_guard lock(mutex_);
    boxes_[static_cast<std::size_t>(to)].emplace_back(from, std::move(text));
  }
  bool receive(int at, int& from, std::string& text) {
    const std::lock_guard lock(mutex_);
    auto& box = boxes_[static_cast<std::size_t>(at)];
    if (box.empty()) return false;
    from = box.front().first;
    text = std::move(box.front().second);
    box.pop_front();
    return true;
  }
  int size() const { return static_cast<int>(boxes_.size()); }

 private:
  std::mutex mutex_;
  std::vector<std::deque<std::pair<int, std::string>>> boxes_;
};

/// Its process may go away without a word.
struct MailLink final : ProcessLink {
  MailLink(Mail& all, int number) : mail(all), me(number) {}
  int rank() const override { return me; }
  int size() const override { return mail.size(); }
  void send(int to, std::string message) override {
    if (!gone) mail.send(me, to, std::move(message));
  }
  bool receive(int& from, std::string& message) override { return !gone && mail.receive(me, from, message); }
  void told_of_loss() override { whole = false; }
  bool is_whole() const override { return whole; }
  Mail& mail;
  int me;
  std::atomic<bool> gone = false, whole = true;
};

SweepRecord::Design analysed(std::int64_t k) {
  SweepRecord::Design design;
  if (k % 10 == 3) {
    design.status = Status::not_assembled;
    design.message = "reason " + std::to_string(k);
  } else {
    design.measures = {std::sqrt(static_cast<double>(k)), -static_cast<double>(k)};
  }
  return design;
}

struct Outcome {
  std::vector<std::optional<SweepRecord::Design>> designs;
  std::vector<std::string> troubles;
  bool leader_is_whole = true;
  std::vector<int> by_process;
};

/// A sweep over `count` designs by followers alone, the process `mortal` of which goes away when it is to analyse a
/// design that `poison` says is the end.
Outcome sweep(int processes, int count, const std::function<bool(int rank, std::int64_t k)>& poison) {
  Mail mail(processes);
  std::deque<MailLink> links;
  for (int rank = 0; rank < processes; ++rank) links.emplace_back(mail, rank);
  const CrewTerms terms{.sweep = 1, .owner = "scene", .patience = 0.8};
  Outcome outcome;
  outcome.designs.resize(static_cast<std::size_t>(count));
  outcome.by_process.resize(static_cast<std::size_t>(processes));
  std::vector<std::jthread> followers;
  std::mutex mutex;
  for (int rank = 1; rank < processes; ++rank) {
    followers.emplace_back([&, rank] {
      MailLink& link = links[static_cast<std::size_t>(rank)];
      follow_crew(
          link,
          [&](std::int64_t k) {
            if (poison(rank, k)) link.gone = true;
            const std::lock_guard lock(mutex);
            ++outcome.by_process[static_cast<std::size_t>(rank)];
            return analysed(k);
          },
          1, [&] { return link.gone.load(); }, terms);
    });
  }
  std::deque<std::int64_t> waiting;
  for (std::int64_t k = 0; k < count; ++k) waiting.push_back(k);
  int missing = count;
  const CrewDesk desk{.take =
                          [&](std::int64_t& k) {
                            if (waiting.empty()) return false;
                            k = waiting.front();
                            waiting.pop_front();
                            return true;
                          },
                      .give =
                          [&](std::int64_t k, SweepRecord::Design design) {
                            auto& place = outcome.designs[static_cast<std::size_t>(k)];
                            if (!place) --missing;
                            place = std::move(design);
                          },
                      .put_back = [&](std::int64_t k) { waiting.push_front(k); },
                      .done = [&] { return missing == 0; }};
  outcome.troubles = lead_crew(links[0], desk, terms);
  outcome.leader_is_whole = links[0].is_whole();
  return outcome;
}

TEST(Crew, DoesEveryDesignOnce) {
  const Outcome outcome = sweep(4, 3000, [](int, std::int64_t) { return false; });
  EXPECT_TRUE(outcome.troubles.empty());
  EXPECT_TRUE(outcome.leader_is_whole);
  int all = 0;
  for (const int n : outcome.by_process) all += n;
  EXPECT_EQ(all, 3000);
  for (std::int64_t k = 0; k < 3000; ++k) {
    const SweepRecord::Design expected = analysed(k), &found = *outcome.designs[static_cast<std::size_t>(k)];
    ASSERT_EQ(found.status, expected.status) << k;
    ASSERT_EQ(found.message, expected.message);
    ASSERT_EQ(found.measures, expected.measures);
  }
}

TEST(Crew, NamesDesignsByRanges) {
  EXPECT_EQ(design_ranges({}), "");
  EXPECT_EQ(design_ranges({6}), "7");
  EXPECT_EQ(design_ranges({2, 4, 5, 6, 11}), "3, 5 to 7 and 12");
  std::set<std::int64_t> odd;
  for (std::int64_t k = 0; k < 20; k += 2) odd.insert(k);
  EXPECT_EQ(design_ranges(odd), "1, 3, 5, 7, 9, 11, 13, 15 and 2 more");
}

TEST(Crew, GivesTheDesignsOfALostProcessToOthers) {
  // The other process waits there, or it might do all that are left before the first one gets any.
  std::atomic<bool> is_lost = false;
  const Outcome outcome = sweep(3, 500, [&](int rank, std::int64_t k) {
    if (rank == 2 && k >= 100) is_lost = true;
    while (rank == 1 && k >= 100 && !is_lost) std::this_thread::yield();
    return rank == 2 && k >= 100;
  });
  ASSERT_EQ(outcome.troubles.size(), 1u);
  EXPECT_TRUE(outcome.troubles[0].starts_with("process 2 was lost after ")) << outcome.troubles[0];
  // The first design that it fell silent at is number 101 or later, and among those that are named.
  const std::size_t names = outcome.troubles[0].find("were given to others: ");
  ASSERT_NE(names, std::string::npos) << outcome.troubles[0];
  EXPECT_GE(std::stoi(outcome.troubles[0].substr(names + 22)), 1) << outcome.troubles[0];
  EXPECT_FALSE(outcome.leader_is_whole);
  for (std::int64_t k = 0; k < 500; ++k)
    EXPECT_EQ(outcome.designs[static_cast<std::size_t>(k)]->measures, analysed(k).measures) << k;
}

TEST(Crew, ADesignThatEndsTwoProcessesFails) {
  const Outcome outcome = sweep(4, 60, [](int, std::int64_t k) { return k == 20; });
  EXPECT_EQ(outcome.troubles.size(), 2u);
  const SweepRecord::Design& poison = *outcome.designs[20];
  EXPECT_EQ(poison.status, Status::refused);
  EXPECT_NE(poison.message.find("while they had this design"), std::string::npos) << poison.message;
  EXPECT_EQ(outcome.designs[59]->measures, analysed(59).measures);
}

}  // namespace
}  // namespace catena::testing
