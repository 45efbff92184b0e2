#include "documents/table.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bench {

namespace {

std::string number_or_dash(double value, const char* format) {
  return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

/// The counts that say most about the work.
std::string few_counts(const Row& row) {
  std::string text;
  for (const char* wanted : {"steps", "iterations", "factorizations", "symbolic", "forces", "gammas", "instructions"}) {
    for (const auto& [name, value] : row.counts) {
      if (name == wanted)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name,
                            value < 1e6 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value));
    }
  }
  return text;
}

std::string clipped(const std::string& text, std::size_t width) {
  return text.size() <= width ? text : text.substr(0, width - 3) + "...";
}

}  // namespace

std::string time_text(double seconds) {
  if (std::isnan(seconds)) return "-";
  constexpr std::pair<double, const char*> units[] = {{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}};
  for (const auto& [size, name] : units) {
    if (seconds >= size || size == 1e-9) {
      const double value = seconds / size;
      return fmt::format("{:.{}f} {}", value, value < 10 ? 2 : value < 100 ? 1 : 0, name);
    }
  }
  return "";
}

std::string table_head() {
  return fmt::format("{:<12}{:<36}{:<30}{:<12}{:>8} {:>9} {:>6} {:>9} {:>9}  {}\n", "suite", "problem", "method",
                     "setting", "bodies", "time", "+-", "error", "B/body", "counts");
}

std::string table_line(const Row& row) {
  const std::string method = row.engine == "catena" ? row.method : row.engine + ": " + row.method;
  std::string line =
      fmt::format("{:<12}{:<36}{:<30}{:<12}{:>8} {:>9} {:>6} {:>9} {:>9}  {}", row.suite, clipped(row.problem, 35),
                  clipped(method, 29), clipped(row.setting, 11), row.bodies, time_text(row.seconds),
                  number_or_dash(100 * row.spread, "{:.0f}%"), number_or_dash(row.error, "{:.1e}"),
                  number_or_dash(row.bytes_per_body, "{:.0f}"), few_counts(row));
  if (!row.failure.empty()) {
    line += "  no answer: " + row.failure.substr(0, row.failure.find('\n'));
  } else if (row.failed()) {
    line += fmt::format("  WRONG: {} may be off by {:.1e}", row.error_of, row.allowed);
  }
  return line + "\n";
}

std::string describe(const Document& document) {
  const Machine& m = document.machine;
  return fmt::format("catena {}, {}{}; {}, {} cores, {:.0f} GB, {}; {}; load {:.2f}", document.catena, document.date,
                     document.brief ? ", brief" : "", m.cpu, m.cores, m.memory / 1e9, m.system, m.compiler, m.load);
}

std::string growth_lines(const std::vector<Row>& rows) {
  std::string out;
  for (const Growth& g : growth_of(rows))
    out += fmt::format("{}: {}: time grows with bodies^{:.2f} ({} sizes from 100 bodies on)\n", g.problem, g.method,
                       g.exponent, g.points);
  return out;
}

std::string comparison_lines(const Comparison& comparison) {
  std::string out = fmt::format("{:>7} {:>15} {:>10} {:>10}  {}\n", "ratio", "between", "now", "then", "row");
  for (const ComparedRow& row : comparison.rows) {
    out += fmt::format("{:>7.3f} {:>15} {:>10} {:>10}  {}{}\n", row.ratio,
                       fmt::format("{:.3f} ... {:.3f}", row.least, row.most), time_text(row.now), time_text(row.then),
                       row.key, row.remark.empty() ? "" : "  (" + row.remark + ")");
  }
  for (const std::string& key : comparison.only_now) out += "new, nothing to compare with: " + key + "\n";
  for (const std::string& key : comparison.only_then) out += "missing, measured then: " + key + "\n";
  for (const std::string& key : comparison.without_time) out += "no time in one of the two: " + key + "\n";
  if (!comparison.rows.empty())
    out +=
        fmt::format("{} rows: ratio of times now / then {:.3f} in the middle, {} clearly slower, {} clearly faster\n",
                    comparison.rows.size(), comparison.median, comparison.slower, comparison.faster);
  if (!comparison.machines.empty()) out += comparison.machines + "\n";
  return out;
}

}  // namespace bench
