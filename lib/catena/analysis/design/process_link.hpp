// Messages between the processes of one job that share the work of a sweep.
#pragma once

#include <string>

namespace catena {

class ProcessLink {
 public:
  virtual ~ProcessLink() = default;
  virtual int rank() const = 0;  ///< of this process; number 0 leads
  virtual int size() const = 0;  ///< how many there are
  /// Does not wait until it has arrived.
  virtual void send(int to, std::string message) = 0;
  /// The next message that has arrived; false where there is none.
  virtual bool receive(int& from, std::string& message) = 0;
  /// Some process does not answer any more: nothing may wait for it.
  virtual void told_of_loss() = 0;
  /// Whether no loss was told: then the link may be ended, which waits for all processes.
  virtual bool is_whole() const = 0;
};

}  // namespace catena
