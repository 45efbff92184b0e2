// A small reader of SVG text for tests: whether it is well formed, and which circles it has.
#pragma once

#include <cctype>
#include <regex>
#include <string>
#include <vector>

#include "catena/base/vec2.hpp"

namespace catena::testing {

/// What is wrong with the markup: elements that do not close, "<" or "&" where they may not be; empty if nothing is.
inline std::string svg_fault(const std::string& text) {
  std::vector<std::string> open;
  std::size_t roots = 0;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '&') {
      const std::size_t end = text.find(';', at);
      const std::string name = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
      if (name != "lt" && name != "gt" && name != "amp" && name != "quot") return "& at " + std::to_string(at);
    }
    if (text[at] != '<') {
      ++at;
      continue;
    }
    const std::size_t end = text.find('>', at);
    const std::string tag = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
    if (tag.empty() || tag.find('<') != std::string::npos) return "< at " + std::to_string(at);
    const std::size_t from = tag[0] == '/' ? 1 : 0;
    std::size_t to = from;
    while (to < tag.size() && std::isalpha(static_cast<unsigned char>(tag[to]))) ++to;
    const std::string name = tag.substr(from, to - from);
    if (name.empty()) return "no name at " + std::to_string(at);
    if (from == 1) {
      if (open.empty() || open.back() != name) return "</" + name + "> closes nothing at " + std::to_string(at);
      open.pop_back();
    } else {
      if (open.empty() && ++roots > 1) return "a second root at " + std::to_string(at);
      if (tag.back() != '/') open.push_back(name);
    }
    at = end + 1;
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

struct SvgCircle {
  Vec2<double> centre;
  double radius;
};

/// y is turned upwards.
inline std::vector<SvgCircle> svg_circles(const std::string& text) {
  static const std::regex circle("<circle cx=\"([-0-9.]+)\" cy=\"([-0-9.]+)\" r=\"([-0-9.]+)\"");
  std::vector<SvgCircle> found;
  for (std::sregex_iterator k(text.begin(), text.end(), circle), end; k != end; ++k)
    found.push_back({{std::stod((*k)[1]), -std::stod((*k)[2])}, std::stod((*k)[3])});
  return found;
}

/// Width and height of the figure.
inline Vec2<double> svg_size(const std::string& text) {
  std::smatch size;
  if (!std::regex_search(text, size, std::regex("<svg [^>]*width=\"([0-9.]+)\" height=\"([0-9.]+)\""))) return {};
  return {std::stod(size[1]), std::stod(size[2])};
}

/// The corners of all paths, y downwards.
inline std::vector<Vec2<double>> svg_corners(const std::string& text) {
  static const std::regex data("<path d=\"([^\"]*)\""), corner("[ML](-?[0-9.]+) (-?[0-9.]+)");
  std::vector<Vec2<double>> found;
  for (std::sregex_iterator path(text.begin(), text.end(), data), end; path != end; ++path) {
    const std::string points = (*path)[1];
    for (std::sregex_iterator k(points.begin(), points.end(), corner); k != end; ++k)
      found.push_back({std::stod((*k)[1]), std::stod((*k)[2])});
  }
  return found;
}

}  // namespace catena::testing
