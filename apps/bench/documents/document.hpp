// A run of `catena bench` as a document: the rows, the machine that they were measured on, and how run times grow. As
// JSON it is {"catena_bench": 1, ...} (apps/manual/benchmarks.md#the-document); read again for comparisons and pages.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "documents/bench_row.hpp"

namespace bench {

struct Machine {
  std::string cpu, system, compiler;
  int cores = 0;      ///< that this process may use
  double load = 0;    ///< average of the last minute: how busy others were
  double memory = 0;  ///< bytes
};

Machine this_machine();

struct Document {
  static constexpr int version = 1;
  std::string catena;  ///< version of the program
  std::string date;    ///< "2026-11-29T02:50:00Z"
  bool brief = false;
  Machine machine;
  std::vector<std::string> notes;  ///< what is missing, and why
  std::vector<Row> rows;
};

/// A file that is no document of this version: what() says what is wrong, with the file's name.
struct DocumentError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// With the version of the program, the time and the machine.
Document make_document(std::vector<Row> rows, std::vector<std::string> notes, bool brief);

std::string to_json(const Document& document);

/// Throws catena::FileError where the file cannot be read, DocumentError where it is something else.
Document read_document(const std::string& path);

/// seconds = constant x bodies^exponent, by least squares of the logarithms over 100 bodies and more.
struct Growth {
  std::string problem, method;
  double exponent = 0;
  int points = 0;
};

/// One for each problem and method of the suite `scaling` with two points and more.
std::vector<Growth> growth_of(const std::vector<Row>& rows);

}  // namespace bench
