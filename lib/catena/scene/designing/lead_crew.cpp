// The leader's side of a sweep that several processes share.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <thread>

#include "catena/scene/designing/crew_messages.hpp"
#include "catena/scene/designing/design_ranges.hpp"
#include "catena/scene/designing/sweep_crew.hpp"

namespace catena {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// A follower, as the leader sees it.
struct Member {
  int rank = 0;
  Clock::time_point heard{}, handed{};
  std::set<std::int64_t> held;  // designs that it has
  std::size_t portion = 1;      // designs of a twentieth of a second
  std::int64_t done = 0;
  bool works = false, lost = false, ever_lost = false;
  std::string trouble;
};

class Leader {
 public:
  Leader(ProcessLink& link, const CrewDesk& desk, const CrewTerms& terms) : link_(link), desk_(desk), terms_(terms) {
    for (int rank = 1; rank < link.size(); ++rank) members_.emplace_back().rank = rank;
  }

  std::vector<std::string> run();
  void lead();

 private:
  void hear(int from, const std::string& message);
  void take_results(Member& member, CrewReader& reader);
  void hand_out(Member& member);
  void look_after(Member& member);
  void lose(Member& member);
  void say_alive();

  ProcessLink& link_;
  const CrewDesk& desk_;
  const CrewTerms& terms_;
  std::vector<Member> members_;
  std::map<std::int64_t, std::vector<int>> lost_with_;  // designs, and the processes with which they were lost
  Clock::time_point began_ = Clock::now(), said_{};
};

void Leader::hear(int from, const std::string& message) {
  CrewReader reader(message);
  const auto word = reader.get<CrewWord>();
  if (reader.get<int>() != terms_.sweep) return;
  Member& member = members_[static_cast<std::size_t>(from - 1)];
  member.heard = Clock::now();
  if (word == CrewWord::hello) {
    member.works = reader.get_text() == terms_.owner;
    if (!member.works)
      member.trouble = fmt::format("process {} has another scene, or another version of catena: it took no part", from);
  }
  if (word == CrewWord::results) take_results(member, reader);
  member.lost = false;
}

void Leader::take_results(Member& member, CrewReader& reader) {
  while (!reader.at_end()) {
    const auto k = reader.get<std::int64_t>();
    SweepRecord::Design design = reader.get_design();
    if (member.held.erase(k) > 0) ++member.done;
    desk_.give(k, std::move(design));
  }
  if (member.held.size() >= (member.portion + 1) / 2) return;
  const Seconds taken = Clock::now() - member.handed;
  // A twentieth of a second, and no more than a small part of what the desk lets be under way.
  if (taken.count() < 0.05 && member.portion < 128) member.portion *= 2;
  if (taken.count() > 0.2 && member.portion > 1) member.portion /= 2;
}

void Leader::hand_out(Member& member) {
  if (member.held.size() >= (member.portion + 1) / 2) return;
  CrewWriter message(CrewWord::designs, terms_.sweep);
  bool any = false;
  for (std::int64_t k = 0; member.held.size() < 2 * member.portion && desk_.take(k); any = true) {
    member.held.insert(k);
    message.put(k);
    // After one that was lost before goes no other, so that few are lost with it.
    if (lost_with_.contains(k)) {
      any = true;
      break;
    }
  }
  if (!any) return;
  member.handed = Clock::now();
  link_.send(member.rank, message.take());
}

void Leader::lose(Member& member) {
  member.lost = member.ever_lost = true;
  member.portion = 1;
  link_.told_of_loss();
  for (const std::int64_t k : member.held) {
    std::vector<int>& with = lost_with_[k];
    with.push_back(member.rank);
    if (with.size() < 2) {
      desk_.put_back(k);
      continue;
    }
    SweepRecord::Design failed;
    failed.status = Status::refused;
    failed.message =
        fmt::format("processes {} and {} ended, or fell silent, while they had this design", with[0], with[1]);
    desk_.give(k, std::move(failed));
  }
  member.trouble = fmt::format("process {} was lost after {} designs; ", member.rank, member.done);
  member.trouble += member.held.empty() ? "it had none at hand"
                                        : fmt::format("the {} that it had were given to others: {}", member.held.size(),
                                                      design_ranges(member.held));
  member.held.clear();
}

void Leader::look_after(Member& member) {
  if (!member.works || member.lost) return;
  if (Seconds(Clock::now() - member.heard).count() > terms_.patience) {
    lose(member);
  } else {
    hand_out(member);
  }
}

void Leader::say_alive() {
  constexpr Seconds beat(0.5);
  if (Clock::now() - said_ < beat) return;
  said_ = Clock::now();
  for (const Member& member : members_) {
    if (!member.lost) link_.send(member.rank, CrewWriter(CrewWord::alive, terms_.sweep).take());
  }
}

void Leader::lead() {
  while (!desk_.done()) {
    bool any = false;
    int from = 0;
    for (std::string message; link_.receive(from, message); any = true) hear(from, message);
    for (Member& member : members_) look_after(member);
    say_alive();
    if (!any) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::vector<std::string> Leader::run() {
  try {
    lead();
  } catch (...) {
    // No member is left waiting for designs that do not come any more.
    for (const Member& member : members_) {
      if (!member.lost) link_.send(member.rank, CrewWriter(CrewWord::stop, terms_.sweep).take());
    }
    throw;
  }
  const bool loss = std::any_of(members_.begin(), members_.end(), [](const Member& m) { return m.ever_lost; });
  std::vector<std::string> troubles;
  const bool long_enough = Seconds(Clock::now() - began_).count() > terms_.patience;
  for (Member& member : members_) {
    if (long_enough && member.heard == Clock::time_point())
      member.trouble = fmt::format("process {} took no part: it was never heard of", member.rank);
    if (!member.lost)
      link_.send(member.rank, CrewWriter(loss ? CrewWord::stop_with_loss : CrewWord::stop, terms_.sweep).take());
    if (!member.trouble.empty()) troubles.push_back(std::move(member.trouble));
  }
  return troubles;
}

}  // namespace

std::vector<std::string> lead_crew(ProcessLink& link, const CrewDesk& desk, const CrewTerms& terms) {
  return Leader(link, desk, terms).run();
}

}  // namespace catena
