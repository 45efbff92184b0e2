// Outcomes of analyses as text for readers: the mechanism, the outcome, and warnings.
#pragma once

#include <string>

#include "catena/results/analysis_result.hpp"
#include "catena/results/result_sink.hpp"

namespace catena {

/// One line: `crank-rocker: 3 bodies, 5 elements, gravity [0, -9.81] m/s^2`.
std::string header_text(const RunHeader& header);

/// First line of a report: `kinematics: ok, 101 rows`.
std::string outcome_text(const AnalysisResult& result);

/// The lines under the table: message, notes, freedoms and redundancy where they matter, named results.
std::string report_text(const AnalysisResult& result);

/// The output of --stats: counters that are not zero, and the time.
std::string counters_text(const AnalysisResult& result);

}  // namespace catena
