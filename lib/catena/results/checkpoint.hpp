// A file from which a motion can be resumed, bit for bit, on the machine that wrote it.
//
// Text: a line with the format's version, then a line a value; floating-point numbers as the 16 hexadecimal digits of
// their bits, so that nothing is rounded; last a checksum over all lines before (FNV-1a, 64 bits). It is written to a
// temporary file beside it, which is then renamed: at any time either the old or the new file exists.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "catena/analysis/motion/motion_memory.hpp"

namespace catena {

struct Checkpoint {
  std::string owner;  ///< fingerprint of what it belongs to: a scene with its parameters, say
  int analysis = 0;   ///< number of the analysis in that scene, from 0
  double begin = 0;   ///< s, where that analysis began
  double every = 0;   ///< s between checkpoints, as it was asked for; 0: the default
  MotionMemory motion;
};

/// The message is a sentence that names the file.
class CheckpointError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws CheckpointError if it cannot be written.
void write_checkpoint(const std::string& path, const Checkpoint& checkpoint);
/// Throws CheckpointError if there is no such file, or it is damaged or of another version.
Checkpoint read_checkpoint(const std::string& path);
/// Throws CheckpointError if no checkpoint can be written there. Does not change an existing file.
void check_checkpoint_place(const std::string& path);
/// Hash of several texts: different for different ones, up to collisions.
std::string fingerprint(std::span<const std::string_view> texts);

}  // namespace catena
