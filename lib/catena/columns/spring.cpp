#include "catena/columns/spring.hpp"

#include "catena/columns/snapshot_state.hpp"
#include "catena/columns/spring_of.hpp"

namespace catena {

SpringLoads spring_loads(const Snapshot& snapshot, int element) {
  return spring_loads_of(SnapshotState(snapshot), element);
}

}  // namespace catena
