// What random mechanisms may have besides joints and springs: elastic and inextensible cables, ropes over pulleys with
// and without friction, contacts with circles that are rigid or springs, rough or smooth. Placed so that some pull or
// press at the start and others do so later.
#pragma once

#include "stress/random_scene.hpp"

namespace catena::testing {

/// A point of a random body, and where it is.
struct RandomEnd {
  Json end;
  Place at;
};
inline RandomEnd random_end(RandomScene& random) {
  const int b = random.pick(static_cast<int>(random.dense.bodies.size()));
  const double x = random.uniform(-1, 1) * random.size, y = random.uniform(-1, 1) * random.size;
  const Eigen::Index k = 3 * b;
  const Place r{double(random.q[k]), double(random.q[k + 1])};
  return {{"b" + std::to_string(b), {x, y}}, r + turned({x, y}, double(random.q[k + 2]))};
}
inline Place random_place(RandomScene& random) {
  const double x = random.uniform(-3, 3), y = random.uniform(-3, 3);
  return {x * random.size, y * random.size};
}
inline double distance_of(Place a, Place b) { return std::hypot(a.x - b.x, a.y - b.y); }
/// A stiffness that masses swing on about as fast as they fall.
inline double random_stiffness(RandomScene& random) {
  const double heaviest = double(random.dense.bodies.front().mass);
  return heaviest * random.pace * random.pace * std::pow(10.0, random.uniform(0, 2));
}

inline void add_pulls(Json& scene, RandomScene& random) {
  for (int n = 1 + random.pick(3); n > 0; --n) {
    const RandomEnd j = random_end(random);
    const Place i = random_place(random);
    const double slack = random.uniform(0.9, 1.1), k = random_stiffness(random);
    const int kind = random.pick(4);
    Json pull = {{"type", "cable"}, {"name", "pull" + std::to_string(n)}, {"i", {"ground", {i.x, i.y}}}, {"j", j.end}};
    if (kind < 3) pull["k"] = k;  // else inextensible, and slack
    if (kind == 2) {
      const Place over = random_place(random);
      const double radius = random.uniform(0.05, 0.3) * random.size;
      const int side = random.pick(2) ? 1 : -1;
      pull["type"] = "rope";
      pull["over"] = Json::array();
      pull["over"].push_back({{"at", {"ground", {over.x, over.y}}}, {"radius", radius}, {"side", side}});
      if (random.pick(6) == 0) pull["over"][0]["mu"] = random.uniform(0.05, 0.3);
      pull["length"] = (distance_of(i, over) + distance_of(over, j.at)) * slack;
    } else {
      pull["length"] = distance_of(i, j.at) * (kind == 3 ? 1 + random.uniform(0.01, 0.1) : slack);
    }
    random.types.push_back(pull["type"]);
    scene["forces"].push_back(std::move(pull));
  }
}

inline void add_contacts(Json& scene, RandomScene& random) {
  for (int n = 1 + random.pick(2); n > 0; --n) {
    const RandomEnd j = random_end(random);
    const Place centre = random_place(random);
    const double radius = distance_of(centre, j.at) * random.uniform(0.8, 0.99);
    Json contact = {{"type", "contact"},
                    {"name", "touch" + std::to_string(n)},
                    {"i", "ground"},
                    {"curve", {{"circle", {{"centre", {centre.x, centre.y}}, {"radius", radius}}}}},
                    {"j", j.end}};
    const double k = random_stiffness(random), damping = random.uniform(0, 0.2);
    const int kind = random.pick(3);
    if (kind > 0) contact["k"] = k;
    if (kind == 2) contact["c"] = k / random.pace * damping;
    if (kind == 0) contact["restitution"] = random.uniform(0.1, 0.9);
    if (random.pick(2)) contact["mu"] = random.uniform(0.05, 0.4);
    random.types.push_back("contact");
    scene["forces"].push_back(std::move(contact));
  }
}

}  // namespace catena::testing
