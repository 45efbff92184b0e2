#include "catena/results/checkpoint.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <fstream>
#include <iterator>
#include <tuple>

#include "catena/results/text_output.hpp"

namespace catena {
namespace {

constexpr std::string_view kind = "catena checkpoint ", first_line = "catena checkpoint 8\n";

std::uint64_t sum_over(std::string_view text, std::uint64_t sum = 0xcbf29ce484222325u) {
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return sum;
}

// The parts of what a checkpoint holds, in the order in which the file has them.
auto parts(EventRecord& record) { return std::tie(record.name, record.event, record.t, record.row); }
auto parts(ConstraintImpulse& p) { return std::tie(p.element, p.x, p.y, p.moment, p.load); }
auto parts(Jolt& jolt) { return std::tie(jolt.t, jolt.event, jolt.drivers, jolt.impulses); }
auto parts(RopeTurns& turns) { return std::tie(turns.theta, turns.contact); }
auto parts(CurvePlace& place) { return std::tie(place.element, place.s_i, place.s_j); }
auto parts(RopeEvent& event) { return std::tie(event.element, event.met, event.t); }
auto parts(SparseVectors& vectors) { return std::tie(vectors.start, vectors.index, vectors.value); }
auto parts(IntegratorMemory& m) {
  return std::tie(m.step, m.rate, m.root_energy, m.root_of_start, m.radians, m.usual_ratio);
}
auto parts(WorkSoFar& m) { return std::tie(m.supplied, m.dissipated, m.initial_energy, m.energy, m.by_driver); }
auto parts(EventMemory& m) { return std::tie(m.released, m.turned, m.sides, m.largest, m.records, m.held); }
auto parts(MotionMemory& m) {
  return std::tie(m.t, m.y, m.turns, m.initial_energy, m.energy, m.length, m.next_row, m.steps, m.rows_given,
                  m.left_out, m.integrator, m.earlier, m.events, m.jolts, m.ropes, m.curves, m.rope_events);
}
auto parts(Checkpoint& c) { return std::tie(c.owner, c.analysis, c.begin, c.every, c.motion); }

template <class T>
concept HasParts = requires(T& value) {
  parts(value);
};

template <class Channel, class T>
void pass(Channel& channel, T& value) {
  std::apply([&](auto&... part) { (channel.value(part), ...); }, parts(value));
}

/// Writes a line a value, or reads it back; damage shows as a CheckpointError.
class Writer {
 public:
  std::string text{first_line};

  void value(std::string& word) { text += word + '\n'; }
  void value(double& number) { text += fmt::format("{:016x}\n", std::bit_cast<std::uint64_t>(number)); }
  void value(std::int64_t& number) { text += fmt::format("{}\n", number); }
  void value(int& number) { text += fmt::format("{}\n", number); }
  template <HasParts T>
  void value(T& record) {
    pass(*this, record);
  }
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
  template <HasParts T>
  void value(T& record) {
    pass(*this, record);
  }
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

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint) {
  Writer writer;
  Checkpoint copy = checkpoint;
  writer.value(copy);
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
  reader.value(checkpoint);
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
