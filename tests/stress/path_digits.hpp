// Digits of random paths of equilibria: what `path` claims beside the points of the true path next to its rows, by
// Newton's method in long double across the tangent.
//
//   particle   F(r, p) = sum k_i (1 - l_i / |r - a_i|) (r - a_i) - p d = 0
//   rod        F(phi, p) = k (phi - phi_0) - p l (d_y cos phi - d_x sin phi) = 0
//
// in lengths and stiffnesses over some orders of magnitude; particles snap through now and then.
#pragma once

#include <functional>

#include "oracles/claimed_digits.hpp"
#include "oracles/scene_text.hpp"
#include "references/dense.hpp"
#include "stress/dense_mechanism.hpp"

namespace catena::testing {

/// Equations of the unknowns z, the parameter the last, one fewer than unknowns; each unknown is O(1) in `scale`.
struct TruePath {
  std::function<Vector(const Vector& z)> equations;
  Vector scale;

  /// By differences in z / scale.
  Matrix gradient(const Vector& z) const {
    constexpr Real h = 1e-6L;
    Matrix g(z.size() - 1, z.size());
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      Vector ahead = z, behind = z;
      ahead[k] += h * scale[k];
      behind[k] -= h * scale[k];
      g.col(k) = (equations(ahead) - equations(behind)) / (2 * h);
    }
    return g;
  }
  /// Goes from z to the path, across its direction; false where it does not arrive.
  bool mend(Vector& z) const {
    Matrix kernel = ReferenceFactors<Real>(gradient(z)).kernel();
    if (kernel.cols() != 1) return false;
    Real last = 1;
    for (int k = 0; k < 6; ++k) {
      Matrix bordered(z.size(), z.size());
      bordered << gradient(z), kernel.transpose();
      Vector side = Vector::Zero(z.size());
      side.head(z.size() - 1) = equations(z);
      const Vector step = solve<Real>(bordered, side);
      z -= step.cwiseProduct(scale);
      last = step.cwiseAbs().maxCoeff();
    }
    return last < 1e-16L;
  }
};

inline Json path_scene(double to, double slope) {
  return {
      {"catena", 1},
      {"parameters", {{"load", 0}}},
      {"bodies", {{"p", {{"mass", 1}}}}},
      {"forces",
       Json::array(
           {{{"type", "point_force"},
             {"i", "p"},
             {"force", {"=load*(" + text_of(std::sin(slope)) + ")", "=load*(" + text_of(-std::cos(slope)) + ")"}}}})},
      {"analyses", Json::array({{{"type", "path"}, {"parameter", "load"}, {"to", to}}})}};
}

/// Adds the columns of one path; how it went, in words. `unknowns`: by name, the parameter the last.
inline std::string add_path(const Json& scene, const TruePath& path, const std::vector<std::string>& unknowns,
                            const std::string& what, ClaimedDigits& claims) {
  const TextRun run = run_text(scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  if (!run.analysis().report.ok()) return std::string(to_string(run.analysis().report.status));
  if (run.analysis().digits.empty()) return "no claim";
  std::vector<std::vector<long double>> exact(unknowns.size());
  const std::size_t rows = run.column(unknowns.back()).size();
  for (std::size_t row = 0; row < rows; ++row) {
    Vector z(static_cast<Eigen::Index>(unknowns.size()));
    for (std::size_t k = 0; k < unknowns.size(); ++k) z[static_cast<Eigen::Index>(k)] = run.column(unknowns[k])[row];
    if (!path.mend(z)) return "not compared";
    for (std::size_t k = 0; k < unknowns.size(); ++k) exact[k].push_back(z[static_cast<Eigen::Index>(k)]);
  }
  for (std::size_t k = 0; k < unknowns.size(); ++k) claims.add(run, unknowns[k], exact[k], what);
  return "compared";
}

inline std::string add_path_of_particle(unsigned seed, ClaimedDigits& claims) {
  RandomNumbers random(seed);
  const double length = std::pow(10.0, random(-3, 3)), stiffness = std::pow(10.0, random(0, 6));
  const double height = random(0.15, 0.9) * length, slope = random(-0.4, 0.4);
  const double to = random(0.2, 3) * stiffness * length;
  struct Spring {
    double x, y, k, rest;
  };
  std::vector<Spring> springs;
  const int count = 2 + static_cast<int>(random(0, 2.999));
  Json scene = path_scene(to, slope);
  for (int k = 0; k < count; ++k) {
    const double x = (k % 2 ? 1 : -1) * random(0.5, 1.5) * length, y = random(-0.4, 0.1) * length;
    const double spring = random(0.3, 3) * stiffness;
    springs.push_back({x, y, spring, std::hypot(x, y - height)});
    scene["forces"].push_back({{"type", "spring_damper"},
                               {"i", {"ground", {x, y}}},
                               {"j", "p"},
                               {"length", springs.back().rest},
                               {"k", spring}});
  }
  scene["bodies"]["p"]["particle"] = true;
  scene["bodies"]["p"]["position"] = {0, height};
  scene["outputs"] = {"p.x", "p.y"};
  TruePath path;
  path.scale = Vector(3);
  path.scale << length, length, to;
  const Real across = std::sin(slope), down = -std::cos(slope), unit = stiffness * length;
  path.equations = [=](const Vector& z) {
    Vector f(2);
    f << -z[2] * across, -z[2] * down;
    for (const Spring& s : springs) {
      const Real hx = z[0] - s.x, hy = z[1] - s.y, l = std::hypot(hx, hy), tension = s.k * (1 - s.rest / l);
      f[0] += tension * hx;
      f[1] += tension * hy;
    }
    return Vector(f / unit);
  };
  return add_path(scene, path, {"p.x", "p.y", "load"}, "particle, seed " + std::to_string(seed), claims);
}

inline std::string add_path_of_rod(unsigned seed, ClaimedDigits& claims) {
  RandomNumbers random(seed);
  const double length = std::pow(10.0, random(-3, 3)), spring = std::pow(10.0, random(-3, 3));
  const double rest = random(-1.5, 1.5), slope = random(-1, 1), to = random(-3, 3) * spring / length;
  Json scene = path_scene(to, slope);
  scene["bodies"]["p"] = {
      {"mass", 1}, {"inertia", 1}, {"position", {length * std::cos(rest), length * std::sin(rest)}}, {"angle", rest}};
  scene["constraints"] = Json::array({{{"type", "revolute"}, {"i", {"ground", {0, 0}}}, {"j", {"p", {-length, 0}}}}});
  scene["forces"].push_back({{"type", "torsion_spring"}, {"i", "ground"}, {"j", "p"}, {"k", spring}, {"angle", rest}});
  scene["outputs"] = {"p.x", "p.y", "p.angle"};
  TruePath path;
  path.scale = Vector(4);
  path.scale << length, length, 1, std::abs(to);
  const Real across = std::sin(slope), down = -std::cos(slope), l = length, k = spring, phi_0 = rest;
  path.equations = [=](const Vector& z) {
    Vector f(3);
    const Real c = std::cos(z[2]), s = std::sin(z[2]);
    f << z[0] / l - c, z[1] / l - s, (z[2] - phi_0) - z[3] * l / k * (down * c - across * s);
    return f;
  };
  return add_path(scene, path, {"p.x", "p.y", "p.angle", "load"}, "rod, seed " + std::to_string(seed), claims);
}

inline std::string add_path_digits(unsigned seed, ClaimedDigits& claims) {
  return seed % 2 ? add_path_of_particle(seed, claims) : add_path_of_rod(seed, claims);
}

}  // namespace catena::testing
