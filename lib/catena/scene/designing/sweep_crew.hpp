// The processes that share the work of a sweep: one leads, gives the rows and keeps the record; the others analyse what
// it hands out.
//
//   follower -> leader   hello (what it is about to sweep);  results of designs;  "alive", twice a second
//   leader -> follower   numbers of designs;  "alive";  stop
//
// A follower has as many designs at hand as it analyses in a twentieth of a second, so that none waits for another at
// the end and messages are few. One from which nothing is heard for `patience` is lost: its designs go to others, and
// one that was lost with two processes fails, with that as its reason, since it may well be what ended them. A process
// that is heard of again after all goes on; results that come twice are the same.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/analysis/design/process_link.hpp"
#include "catena/scene/models/sweep_record.hpp"

namespace catena {

struct CrewTerms {
  int sweep = 1;             ///< number of the sweep in the run: messages of other sweeps are dropped
  std::string_view owner{};  ///< a hash of what is swept: a process with another one cannot take part
  double patience = 10;      ///< s
};

/// Where the leader gets designs from and takes them to, numbered from 0.
struct CrewDesk {
  std::function<bool(std::int64_t& k)> take;  ///< the next design; false if there is none now
  std::function<void(std::int64_t k, SweepRecord::Design design)> give;  ///< one that is done
  std::function<void(std::int64_t k)> put_back;                          ///< one that was taken and will not be done
  std::function<bool()> done;                                            ///< nothing is left to wait for
};

/// Hands designs out until the desk is done. Returns what is to be said of processes that did not do their part.
std::vector<std::string> lead_crew(ProcessLink& link, const CrewDesk& desk, const CrewTerms& terms);

/// Analyses what the leader hands out, in `threads` threads, until it says stop or `cancelled`. Throws
/// std::runtime_error where the leader is lost.
void follow_crew(ProcessLink& link, const std::function<SweepRecord::Design(std::int64_t k)>& analyse, int threads,
                 const std::function<bool()>& cancelled, const CrewTerms& terms);

}  // namespace catena
