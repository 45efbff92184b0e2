#include "catena/results/checkpoint.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <fstream>
#include <iterator>

#include "catena/results/text_output.hpp"

namespace catena {
namespace {

constexpr std::string_view kind = "catena checkpoint ", first_line = "catena checkpoint 5\n";

std::uint64_t sum_over(std::string_view text, std::uint64_t sum = 0xcbf29ce484222325u) {
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return sum;
}

/// The order of the values in the file.
template <class Channel>
void pass(Channel& channel, EventRecord& record) {
  channel.value(record.name);
  channel.value(record.event);
  channel.value(record.t);
  channel.value(record.row);
}

template <class Channel>
void pass(Channel& channel, ConstraintImpulse& impulse) {
  channel.value(impulse.element);
  channel.value(impulse.x);
  channel.value(impulse.y);
  channel.value(impulse.moment);
  channel.value(impulse.load);
}

template <class Channel>
void pass(Channel& channel, Jolt& jolt) {
  channel.value(jolt.t);
  channel.value(jolt.event);
  channel.value(jolt.drivers);
  channel.value(jolt.impulses);
}

template <class Channel>
void pass(Channel& channel, RopeTurns& turns) {
  channel.value(turns.theta);
  channel.value(turns.contact);
}

template <class Channel>
void pass(Channel& channel, CurvePlace& place) {
  channel.value(place.element);
  channel.value(place.s_i);
  channel.value(place.s_j);
}

template <class Channel>
void pass(Channel& channel, RopeEvent& event) {
  channel.value(event.element);
  channel.value(event.met);
  channel.value(event.t);
}

/// Writes a line a value, or reads it back; damage shows as a CheckpointError.
class Writer {
 public:
  std::string text{first_line};

  void value(std::string& word) { text += word + '\n'; }
  void value(double& number) { text += fmt::format("{:016x}\n", std::bit_cast<std::uint64_t>(number)); }
  void value(std::int64_t& number) { text += fmt::format("{}\n", number); }
  void value(int& number) { text += fmt::format("{}\n", number); }
  void value(EventRecord& record) { pass(*this, record); }
  void value(ConstraintImpulse& impulse) { pass(*this, impulse); }
  void value(Jolt& jolt) { pass(*this, jolt); }
  void value(RopeTurns& turns) { pass(*this, turns); }
  void value(CurvePlace& place) { pass(*this, place); }
  void value(RopeEvent& event) { pass(*this, event); }
  template <class T>
  void value(std::vector<T>& list) {
    text += fmt::format("{}\n", list.size());
    for (T& entry : list) value(entry);
  }
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  void value(std::string& word) { word = line(); }
  void value(double& number) { number = std::bit_cast<double>(whole<std::uint64_t>(16)); }
  void value(std::int64_t& number) { number = whole<std::int64_t>(10); }
  void value(int& number) { number = whole<int>(10); }
  void value(EventRecord& record) { pass(*this, record); }
  void value(ConstraintImpulse& impulse) { pass(*this, impulse); }
  void value(Jolt& jolt) { pass(*this, jolt); }
  void value(RopeTurns& turns) { pass(*this, turns); }
  void value(CurvePlace& place) { pass(*this, place); }
  void value(RopeEvent& event) { pass(*this, event); }
  template <class T>
  void value(std::vector<T>& list) {
    const auto size = whole<std::size_t>(10);
    if (size > rest_.size()) damaged();
    list.resize(size);
    for (T& entry : list) value(entry);
  }
  [[noreturn]] void damaged() const {
    throw CheckpointError(fmt::format("the checkpoint \"{}\" is damaged: it was cut short or changed", path_));
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) damaged();
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line;
  }
  template <class Whole>
  Whole whole(int base) {
    const std::string_view digits = line();
    Whole number{};
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
    if (code != std::errc() || end != digits.data() + digits.size()) damaged();
    return number;
  }

  std::string_view rest_;
  const std::string& path_;
};

template <class Channel>
void pass(Channel& channel, Checkpoint& checkpoint) {
  channel.value(checkpoint.owner);
  channel.value(checkpoint.analysis);
  channel.value(checkpoint.begin);
  channel.value(checkpoint.every);
  MotionMemory& motion = checkpoint.motion;
  channel.value(motion.t);
  channel.value(motion.y);
  channel.value(motion.turns);
  channel.value(motion.initial_energy);
  channel.value(motion.next_row);
  channel.value(motion.steps);
  channel.value(motion.rows_given);
  channel.value(motion.left_out.start);
  channel.value(motion.left_out.index);
  channel.value(motion.left_out.value);
  channel.value(motion.integrator.step);
  channel.value(motion.integrator.rate);
  channel.value(motion.integrator.root_energy);
  channel.value(motion.integrator.radians);
  channel.value(motion.integrator.usual_ratio);
  channel.value(motion.earlier.supplied);
  channel.value(motion.earlier.dissipated);
  channel.value(motion.earlier.initial_energy);
  channel.value(motion.earlier.energy);
  channel.value(motion.earlier.by_driver);
  channel.value(motion.events.released);
  channel.value(motion.events.turned);
  channel.value(motion.events.sides);
  channel.value(motion.events.largest);
  channel.value(motion.events.records);
  channel.value(motion.jolts);
  channel.value(motion.ropes);
  channel.value(motion.curves);
  channel.value(motion.rope_events);
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  Writer writer;
  Checkpoint copy = checkpoint;
  pass(writer, copy);
  writer.text += fmt::format("{:016x}\n", sum_over(writer.text));
  TextOutput file = TextOutput::file(path);
  file.write(writer.text);
  if (!file.commit()) throw CheckpointError(file.error());
}

Checkpoint read_checkpoint(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw CheckpointError(fmt::format("there is no checkpoint \"{}\", or it cannot be read", path));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!text.starts_with(first_line)) {
    if (text.starts_with(kind)) {
      throw CheckpointError(
          fmt::format("the checkpoint \"{}\" has a format of another version of catena: run the scene from its start "
                      "again",
                      path));
    }
    throw CheckpointError(fmt::format("\"{}\" is no checkpoint", path));
  }
  constexpr std::size_t sum_line = 17;
  const Reader whole(text, path);
  if (text.size() < first_line.size() + sum_line) whole.damaged();
  const std::string_view body = std::string_view(text).substr(0, text.size() - sum_line);
  if (std::string_view(text).substr(body.size()) != fmt::format("{:016x}\n", sum_over(body))) whole.damaged();
  Reader reader(body.substr(first_line.size()), path);
  Checkpoint checkpoint;
  pass(reader, checkpoint);
  if (!reader.at_end()) reader.damaged();
  return checkpoint;
}

void check_checkpoint_place(const std::string& path) {
  const TextOutput file = TextOutput::file(path);
  if (!file.ok()) throw CheckpointError(file.error());
}

std::string fingerprint(std::span<const std::string_view> texts) {
  std::uint64_t sum = sum_over({});
  std::size_t length = 0;
  for (const std::string_view text : texts) {
    // With its length, so that texts do not run into each other.
    sum = sum_over(fmt::format("{}:", text.size()), sum);
    sum = sum_over(text, sum);
    length += text.size();
  }
  return fmt::format("{:016x}-{}", sum, length);
}

}  // namespace catena
