// The page of a run: machine, plots, rows by suite. Everything stands in one file.
#include <fmt/format.h>

#include "documents/figures.hpp"
#include "documents/table.hpp"
#include "suites/suites.hpp"

namespace bench {

namespace {

constexpr const char* style =
    "body{font:14px/1.4 system-ui,sans-serif;color:#222;background:#fff;margin:24px auto;max-width:1200px;padding:0 "
    "16px}"
    "table{border-collapse:collapse;font-size:12px;width:100%}th,td{border-bottom:1px solid #d8dbe0;padding:3px 6px;"
    "text-align:left;vertical-align:top}td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}"
    "tr.bad td{color:#b23a00}.plots{display:flex;flex-wrap:wrap;gap:16px}.plots svg{max-width:100%;height:auto}"
    "p.faint,li{color:#555}";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

/// Figures of one page need names of their own for what they clip to.
std::string inlined(std::string svg, std::size_t number) {
  const std::string name = "f" + std::to_string(number) + "clip";
  for (const std::string_view before : {"id=\"clip", "url(#clip"}) {
    for (std::size_t at = svg.find(before); at != std::string::npos; at = svg.find(before, at + name.size()))
      svg.replace(at + before.size() - 4, 4, name);
  }
  return svg;
}

std::string cell(double value, const char* format) {
  return "<td class=\"n\">" + (value == value ? fmt::format(fmt::runtime(format), value) : std::string("-")) + "</td>";
}

void append_html_row(std::string& out, const Row& row) {
  std::string counts;
  for (const auto& [name, value] : row.counts)
    counts += fmt::format("{}{} {:.6g}", counts.empty() ? "" : ", ", name, value);
  out += fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td>", row.failed() ? " class=\"bad\"" : "",
                     escaped(row.problem), escaped(row.engine), escaped(row.method), escaped(row.setting));
  out += cell(row.bodies, "{:.0f}") + "<td class=\"n\">" + time_text(row.seconds) + "</td>";
  out += cell(100 * row.spread, "{:.0f}%") + cell(row.repeats, "{:.0f}") + cell(row.error, "{:.1e}");
  out += cell(row.bytes_per_body, "{:.0f}");
  out += "<td>" + escaped(row.failure.empty() ? row.error_of : row.failure) + "</td><td>" + escaped(row.reference) +
         "</td><td>" + escaped(counts) + "</td></tr>\n";
}

}  // namespace

std::string page_of(const Document& document) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>catena bench</title>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><style>{}</style></head><body>\n"
      "<h1>catena bench</h1>\n<p>{}</p>\n<p class=\"faint\">Times are processor times, the least of many repeats; +- "
      "is "
      "how far their median lies above it. Errors are taken against references that share no code with the library. In "
      "the plots of error over time, lower and further left is better; a line ends where no smaller error was "
      "reached.</p>\n",
      style, escaped(describe(document)));
  if (!document.notes.empty()) {
    out += "<ul>\n";
    for (const std::string& note : document.notes) out += "<li>" + escaped(note) + "</li>\n";
    out += "</ul>\n";
  }
  out += "<div class=\"plots\">\n";
  std::size_t number = 0;
  for (const Figure& figure : figures_of(document)) out += "<figure>" + inlined(figure.svg, ++number) + "</figure>\n";
  out += "</div>\n";
  if (const auto fits = growth_of(document.rows); !fits.empty()) {
    out +=
        "<h2>growth</h2>\n<table><tr><th>problem</th><th>method</th><th>time grows with bodies to the "
        "power</th></tr>\n";
    for (const Growth& g : fits)
      out += fmt::format("<tr><td>{}</td><td>{}</td>{}</tr>\n", escaped(g.problem), escaped(g.method),
                         cell(g.exponent, "{:.2f}"));
    out += "</table>\n";
  }
  for (const Suite& suite : suites) {
    std::string rows;
    for (const Row& row : document.rows) {
      if (row.suite == suite.name) append_html_row(rows, row);
    }
    if (rows.empty()) continue;
    out += fmt::format(
        "<h2>{}</h2>\n<table><tr><th>problem</th><th>engine</th><th>method</th><th>setting</th><th>bodies</th><th>time"
        "</th><th>+-</th><th>repeats</th><th>error</th><th>bytes a body</th><th>error of</th><th>against</th>"
        "<th>counts</th></tr>\n{}</table>\n",
        suite.name, rows);
  }
  return out + "</body></html>\n";
}

}  // namespace bench
