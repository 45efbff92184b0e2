// The processes of an MPI job, as a module that `catena` loads where it was started by mpirun, so that no other
// program waits for MPI's libraries. MPI without its old C++ classes.
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdlib>
#include <deque>
#include <string>

#include "catena/analysis/design/process_link.hpp"

namespace catena::cli {
namespace {

class MpiLink final : public ProcessLink {
 public:
  MpiLink() {
    int provided = 0;
    // Threads that analyse never speak with others.
    PMPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    PMPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~MpiLink() override { PMPI_Finalize(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void told_of_loss() override { loss_ = true; }
  bool is_whole() const override { return !loss_; }

  void send(int to, std::string message) override {
    while (!under_way_.empty()) {
      int arrived = 0;
      PMPI_Test(&under_way_.front().request, &arrived, MPI_STATUS_IGNORE);
      if (!arrived) break;
      under_way_.pop_front();
    }
    Sent& sent = under_way_.emplace_back(std::move(message), MPI_Request{});
    PMPI_Isend(sent.text.data(), static_cast<int>(sent.text.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD, &sent.request);
  }

  bool receive(int& from, std::string& message) override {
    int any = 0, bytes = 0;
    MPI_Status status;
    PMPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &any, &status);
    if (!any) return false;
    PMPI_Get_count(&status, MPI_BYTE, &bytes);
    from = status.MPI_SOURCE;
    message.resize(static_cast<std::size_t>(bytes));
    PMPI_Recv(message.data(), bytes, MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return true;
  }

 private:
  struct Sent {
    std::string text;
    MPI_Request request;
  };
  int rank_ = 0, size_ = 1;
  bool loss_ = false;
  std::deque<Sent> under_way_;  // texts stay where they are
};

}  // namespace
}  // namespace catena::cli

extern "C" catena::ProcessLink* catena_mpi_link() { return new catena::cli::MpiLink; }
