#include "documents/peers.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "cases/contact_problems.hpp"
#include "cases/exact_chain.hpp"
#include "cases/pendulum_gradient.hpp"
#include "catena/scene/json/source_text.hpp"

namespace bench {

namespace {

namespace fs = std::filesystem;

/// What a program is asked for, the table that it answers with, and the suite that this belongs to. Programs whose
/// names begin with `only` know no other scene, and no other program knows this one.
struct PeerScene {
  const char* scene;
  const char* table;
  const char* suite;
  std::string_view only = {};
};
constexpr PeerScene scenes[] = {{"acceleration", "S1a", "kernels"},
                                {"chain", "S1b", "dynamics"},
                                {"fourbar", "S2", "dynamics"},
                                {"squeezer", "S3", "dynamics"},
                                {"equilibrium", "S4", "equilibrium"},
                                {"gradient", "S5", "design", "peer_cvodes"},
                                {"contact", "S6", "contact", "peer_contact_"}};
/// Programs of this repository (peers/CMakeLists.txt), and the suites that they have rows in.
struct KnownProgram {
  std::string_view name;
  std::string_view suite;
};
constexpr KnownProgram known_programs[] = {
    {"peer_contact_box2d", "contact"},  {"peer_contact_bullet", "contact"}, {"peer_contact_chipmunk", "contact"},
    {"peer_contact_mujoco", "contact"}, {"peer_contact_ode", "contact"},    {"peer_contact_siconos", "contact"},
    {"peer_cvodes", "design"},          {"peer_bullet", "dynamics"},        {"peer_dart", "dynamics"},
    {"peer_mujoco", "dynamics"},        {"peer_simbody", "dynamics"}};
constexpr int time_limit = 60;    // s a scene; records printed so far are kept
constexpr int unknown_scene = 2;  // exit status of a program that does not have it

using Fields = std::vector<std::string>;

Fields fields_of(const std::string& line) {
  Fields fields;
  std::istringstream text(line);
  for (std::string field; std::getline(text, field, '\t');) fields.push_back(field);
  return fields;
}

double number(const Fields& fields, std::size_t k) {
  if (k >= fields.size()) return not_measured;
  char* end = nullptr;
  const double value = std::strtod(fields[k].c_str(), &end);
  return end == fields[k].c_str() ? not_measured : value;
}

/// Of the tip of the chain of rods at angles 0.3 sin k, rates 0.1 cos k.
double tip_error(int rods, double ax, double ay) {
  ExactChain chain(rods);
  for (int k = 0; k < rods; ++k) {
    chain.angle[static_cast<std::size_t>(k)] = 0.3 * std::sin(k + 1);
    chain.rate[static_cast<std::size_t>(k)] = 0.1 * std::cos(k + 1.0);
  }
  return static_cast<double>(norm(chain.tip_acceleration() - catena::Vec2<long double>{ax, ay}));
}

/// The row of one evaluation of a chain.
bool read_kernel(const Fields& f, Row& row) {
  row.suite = "kernels", row.problem = "chain of rods", row.bodies = std::atoi(f[3].c_str());
  row.seconds = 1e-6 * number(f, 5);
  if (row.bodies < 1) return false;
  row.error = tip_error(row.bodies, number(f, 6), number(f, 7));
  row.error_of = "acceleration of the tip, m/s^2";
  row.reference = "Newton-Euler in 64 bits";
  return true;
}

/// The row of a record; false for lines that are none, for catena's own, and for tables that no suite has.
bool read_record(const Fields& f, Row& row) {
  if (f.size() < 3 || f[1] == "catena" || f[1] == "reference") return false;
  row.engine = f[1];
  row.method = f[2];
  row.repeats = 1;
  row.reference = "that of the program that runs the engine";
  if (f[0] == "S1a" && f.size() >= 8) return read_kernel(f, row);
  row.suite = "dynamics";
  if (f.size() > 3) row.setting = f[3];
  const auto steps = [&] {
    if (const double n = number(f, 4); n > 0) row.counts.emplace_back("steps", n);
  };
  if (f[0] == "S1b" && f.size() >= 9) {
    row.problem = "40 rods fall", row.bodies = 40;
    row.seconds = 1e-3 * number(f, 5), row.error = number(f, 8), row.error_of = "worst joint, m";
    steps();
    return true;
  }
  if (f[0] == "S2" && f.size() >= 8) {
    row.problem = "A02, N = " + f[4], row.bodies = 2 * std::atoi(f[4].c_str()) + 1;
    row.seconds = 1e-3 * number(f, 5), row.error = number(f, 7), row.error_of = "end of a crank, m";
    return true;
  }
  if (f[0] == "S3" && f.size() >= 7) {
    row.problem = "Andrews' squeezer", row.bodies = 7;
    row.seconds = 1e-3 * number(f, 5), row.error = number(f, 6), row.error_of = "worst angle, rad";
    steps();
    return true;
  }
  if (f[0] == "S4" && f.size() >= 8) {
    row.suite = "equilibrium", row.problem = "chain between pins", row.bodies = std::atoi(f[4].c_str());
    if (row.bodies < 1) return false;
    row.seconds = 1e-3 * number(f, 5), row.error = number(f, 7) / row.bodies, row.error_of = "worst joint, m a rod";
    return true;
  }
  if (f[0] == "S5" && f.size() >= 8) {
    row.suite = "design", row.bodies = std::atoi(f[4].c_str());
    for (const PendulumProblem& of : pendulum_problems) {
      if (of.rods == row.bodies) row.problem = of.name;
    }
    row.seconds = 1e-3 * number(f, 5), row.error = number(f, 7), row.error_of = "derivatives, relative";
    row.counts.emplace_back("parameters", number(f, 6));
    return !row.problem.empty();
  }
  if (f[0] == "S6" && f.size() >= 8) {
    row.suite = "contact", row.problem = f[4];
    row.bodies = row.problem == BouncingBalls::name       ? BouncingBalls::count
                 : row.problem == BouncingDumbbells::name ? BouncingDumbbells::count
                                                          : 1;
    row.counts.emplace_back("steps", number(f, 5));
    row.seconds = 1e-3 * number(f, 6), row.error = number(f, 7), row.error_of = "worst place, m";
    return true;
  }
  return false;
}

/// How many rows came of it.
int add_records(Bench& bench, const std::string& text, const std::function<bool(std::string_view)>& wanted) {
  int count = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    Row row;
    if (!read_record(fields_of(line), row) || !wanted(row.suite) || !bench.wants(row)) continue;
    bench.add(std::move(row));
    ++count;
  }
  return count;
}

void run_program(Bench& bench, const fs::path& program, const std::function<bool(std::string_view)>& wanted) {
  const std::string file = program.filename().string();
  const auto is_of = [&](const PeerScene& scene) { return !scene.only.empty() && file.starts_with(scene.only); };
  const bool special = std::any_of(std::begin(scenes), std::end(scenes), is_of);
  for (const PeerScene& scene : scenes) {
    if (!wanted(scene.suite) || (special ? !is_of(scene) : !scene.only.empty())) continue;
    std::string quoted = "'";
    for (const char c : program.string()) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    const std::string command =
        "OMP_NUM_THREADS=1 timeout " + std::to_string(time_limit) + " " + quoted + "' " + scene.scene + " 2>/dev/null";
    std::string output;
    int status = -1;
    if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
      char buffer[4096];
      while (const std::size_t read = std::fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, read);
      status = ::pclose(pipe);
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == unknown_scene) continue;
    const int rows = add_records(bench, output, wanted);
    const std::string name = program.filename().string() + " " + scene.scene;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 124) {
      bench.remark(fmt::format("peers: {} was ended after {} s; {} of its records are kept", name, time_limit, rows));
    } else if (status != 0 || rows == 0) {
      bench.remark(fmt::format("peers: {} gave {} records, exit status {}", name, rows,
                               WIFEXITED(status) ? WEXITSTATUS(status) : status));
    }
  }
}

/// Tells which of the known ones are not there.
void remark_absent(Bench& bench, const std::vector<fs::path>& programs,
                   const std::function<bool(std::string_view)>& wanted) {
  std::string absent;
  for (const KnownProgram& known : known_programs) {
    const auto is_it = [&](const fs::path& program) { return program.filename().string() == known.name; };
    if (!wanted(known.suite) || std::any_of(programs.begin(), programs.end(), is_it)) continue;
    absent += fmt::format("{}{} ({})", absent.empty() ? "" : ", ", known.name, known.suite);
  }
  if (!absent.empty()) bench.remark("peers: absent, and no rows of theirs: " + absent);
}

}  // namespace

void add_peers(Bench& bench, const std::function<bool(std::string_view)>& wanted) {
  const std::string& path = bench.options().peers;
  if (path.empty()) {
    bench.remark("peers: none was run: no folder of their programs was named (--peers)");
    return;
  }
  if (!fs::is_directory(path)) {
    const catena::SourceText records = catena::SourceText::read(path);
    const int rows = add_records(bench, std::string(records.text()), wanted);
    bench.remark(
        fmt::format("peers: {} records from {}, not measured in this run", rows, fs::path(path).filename().string()));
    return;
  }
  std::vector<fs::path> programs;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (entry.is_regular_file() && entry.path().filename().string().starts_with("peer_") &&
        (entry.status().permissions() & fs::perms::owner_exec) != fs::perms::none)
      programs.push_back(entry.path());
  }
  std::sort(programs.begin(), programs.end());
  if (programs.empty()) bench.remark("peers: none was run: " + path + " has no program peer_NAME");
  for (const fs::path& program : programs) run_program(bench, program, wanted);
  if (!programs.empty()) remark_absent(bench, programs, wanted);
}

}  // namespace bench
