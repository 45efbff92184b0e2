// Two runs of `catena bench` beside each other, row by row.
//
//   ratio = least now / least then      least ... most = the ratios that their spreads leave open:
//     least now / median then ... median now / least then
//
// Where 1 lies within, the two do not clearly differ. Rows are the same where their keys are (Row::key).
#pragma once

#include <string>
#include <vector>

#include "documents/document.hpp"

namespace bench {

struct ComparedRow {
  std::string key;
  double ratio = 0, least = 0, most = 0;
  double now = 0, then = 0;  ///< s
  std::string remark{};      ///< errors that grew tenfold, answers that are gone
};

struct Comparison {
  std::vector<ComparedRow> rows;
  std::vector<std::string> only_now, only_then, without_time;  ///< keys
  double median = 0;                                           ///< of the ratios
  int slower = 0, faster = 0;                                  ///< rows whose ratio is clearly above or below 1
  std::string machines{};                                      ///< what differs between the machines; may be empty
};

Comparison compare(const Document& now, const Document& then);

}  // namespace bench
