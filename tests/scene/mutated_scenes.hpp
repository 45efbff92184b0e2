// Scenes with mistakes in them, made from good ones: a token or a member of the text changed, renamed, moved, left out.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "results/temporary_folder.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {

class SceneMutation {
 public:
  SceneMutation(std::string text, unsigned seed) : text_(std::move(text)), random_(seed) {}

  std::string make() {
    for (int k = 1 + pick(3); k > 0; --k) change();
    if (pick(20) == 0) text_.resize(static_cast<std::size_t>(pick(static_cast<int>(text_.size()) + 1)));
    return text_;
  }

 private:
  struct Token {
    std::size_t first, last;
    bool key;
  };

  int pick(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

  /// Strings, numbers and words of the text; comments are passed over.
  std::vector<Token> tokens() const {
    std::vector<Token> found;
    for (std::size_t at = 0; at < text_.size();) {
      const char c = text_[at];
      std::size_t end = at + 1;
      if (text_.compare(at, 2, "//") == 0) {
        at = std::min(text_.find('\n', at), text_.size());
        continue;
      }
      if (c == '"') {
        while (end < text_.size() && text_[end] != '"') end += text_[end] == '\\' ? 2 : 1;
        end = std::min(end + 1, text_.size());
      } else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-') {
        while (end < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[end])) || text_[end] == '.' ||
                                      text_[end] == '-' || text_[end] == '+'))
          ++end;
      } else {
        ++at;
        continue;
      }
      const std::size_t next = text_.find_first_not_of(" \n\t", end);
      found.push_back({at, end, next != std::string::npos && text_[next] == ':'});
      at = end;
    }
    return found;
  }

  void change() {
    static const std::vector<std::string> others{"null",       "true",   "0",           "-1",      "1e308",
                                                 "1e-308",     "3",      "\"\"",        "\"x\"",   "\"=1/0\"",
                                                 "[]",         "{}",     "[0,0]",       "\"1 m\"", "\"30 deg\"",
                                                 "\"ground\"", "\"=k\"", "[[0,0],[1]]", "\"{k}\"", "\"=sqrt(-1)\""};
    const std::vector<Token> all = tokens();
    if (all.empty()) return;
    const Token t = all[static_cast<std::size_t>(pick(static_cast<int>(all.size())))];
    std::string word = text_.substr(t.first, t.last - t.first);
    const bool number = !t.key && word.find_first_not_of("-0123456789.eE+") == std::string::npos;
    switch (number ? pick(6) : 4 + pick(5)) {
      case 0:
      case 1:
      case 2:
      case 3: {
        static const char* const factors[] = {"-", "1e3", "1e-3", "1e9", "1e-9", "0"};
        const double value = std::atof(word.c_str());
        const std::string factor = factors[pick(6)];
        const double changed = factor == "-" ? -value : value * std::atof(factor.c_str());
        word = std::to_string(changed);
        break;
      }
      case 4:
        word = others[static_cast<std::size_t>(pick(static_cast<int>(others.size())))];
        if (t.key) word = "\"" + std::string(1, static_cast<char>('a' + pick(26))) + "\"";
        break;
      case 5: {
        const Token o = all[static_cast<std::size_t>(pick(static_cast<int>(all.size())))];
        word = text_.substr(o.first, o.last - o.first);
        break;
      }
      case 6:
        if (word.size() > 2) word.erase(1 + static_cast<std::size_t>(pick(static_cast<int>(word.size()) - 2)), 1);
        break;
      case 7:
        if (word.size() > 1) word.insert(1 + static_cast<std::size_t>(pick(static_cast<int>(word.size()) - 1)), "e");
        break;
      default: {
        // The whole member or entry, up to the comma or bracket that ends it.
        int depth = 0;
        std::size_t end = t.last;
        for (; end < text_.size(); ++end) {
          const char c = text_[end];
          if (c == '{' || c == '[') ++depth;
          if ((c == '}' || c == ']') && depth-- == 0) break;
          if (c == ',' && depth == 0) {
            ++end;
            break;
          }
        }
        text_.erase(t.first, end - t.first);
        return;
      }
    }
    text_.replace(t.first, t.last - t.first, word);
  }

  std::string text_;
  std::mt19937 random_;
};

/// The smaller scenes of data/scenes.
inline std::vector<std::string> good_scenes() {
  std::vector<std::string> paths, texts;
  const std::filesystem::path folder = std::filesystem::path(CATENA_DATA_DIR) / "scenes";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  for (const std::string& path : paths) {
    if (path.find("100000") == std::string::npos) texts.push_back(read_file(path));
  }
  return texts;
}

/// A user who waits for so long and then stops the program.
class Impatience {
 public:
  explicit Impatience(double seconds)
      : waiter_([this, seconds] {
          std::unique_lock lock(mutex_);
          stopped_ = !ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return has_ended_; });
        }) {}
  ~Impatience() {
    {
      const std::lock_guard lock(mutex_);
      has_ended_ = true;
    }
    ended_.notify_one();
    waiter_.join();
  }
  Impatience(const Impatience&) = delete;
  Impatience& operator=(const Impatience&) = delete;
  const std::atomic<bool>* stopped() const { return &stopped_; }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::atomic<bool> stopped_ = false;
  std::thread waiter_;  // the last: it uses all others
};

/// Runs `count` mutations and checks of each: an outcome that says what is wrong, numbers that are numbers, an end in
/// bounded time. What a mutation makes a thousand times as long may well take its time (a belt that turns by 1e8 rad
/// takes some 20 minutes): it is stopped after half of `most_seconds`, and has to end in the other half.
inline void run_mutated_scenes(int count, unsigned seed, double most_seconds) {
  const std::vector<std::string> scenes = good_scenes();
  int wrong = 0, solved = 0, stopped = 0;
  for (int k = 0; k < count; ++k) {
    const auto number = static_cast<unsigned>(k) + seed;
    const std::string text = SceneMutation(scenes[number % scenes.size()], number).make();
    const auto start = std::chrono::steady_clock::now();
    TemporaryFolder folder;
    const std::string path = folder / "scene.json", out = folder / "out.json";
    std::ofstream(path, std::ios::binary) << text;
    TextOutput output = TextOutput::file(out);
    const std::unique_ptr<ResultSink> sink = json_result_sink(output);
    RunOptions options;
    options.max_elements = 20000;
    const Impatience user(most_seconds / 2);
    options.cancel = user.stopped();
    SceneOutcome outcome;
    EXPECT_NO_THROW(outcome = run_scene(path, options, *sink)) << text;
    output.commit();
    const std::string results = read_file(out);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, most_seconds) << text;
    ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1 || outcome.exit_code == 3)
        << outcome.exit_code << outcome.error_text << text;
    stopped += *user.stopped();
    wrong += outcome.exit_code == 3;
    solved += outcome.exit_code == 0;
    if (outcome.exit_code == 3) {
      EXPECT_FALSE(outcome.errors.empty()) << text;
      for (const Diagnostic& error : outcome.errors) EXPECT_FALSE(error.message.empty()) << text;
    }
    bool all_ok = true;
    for (const AnalysisResult& result : outcome.analyses) {
      all_ok = all_ok && result.report.ok();
      if (result.report.ok()) continue;
      EXPECT_FALSE(result.report.message.empty()) << text;
      for (const char* internal : {"std::", "vector::", "map::at", "BlockFactorization", "basic_string"}) {
        EXPECT_EQ(result.report.message.find(internal), std::string::npos) << result.report.message << text;
      }
    }
    if (outcome.exit_code < 2) {
      EXPECT_EQ(outcome.exit_code == 0, all_ok) << text;
    }
    for (const char* bad : {": nan", ": inf", ": -inf", ", nan", ", inf", "[nan", "[inf", ": -nan", ", -nan"}) {
      EXPECT_EQ(results.find(bad), std::string::npos) << text;
    }
  }
  // The mutations should be mistakes for the most part, but not all: what is only odd must run.
  EXPECT_GT(wrong, count / 4);
  EXPECT_GT(solved, count / 20);
  // Measured: 1 of 10,000.
  EXPECT_LE(stopped, 1 + count / 2000);
}

}  // namespace catena::testing
