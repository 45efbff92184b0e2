// MuJoCo on motions without contact: joint coordinates, the composite rigid body algorithm; loops closed by soft
// `connect` constraints, as stiff as its documentation allows: a time constant of two steps, impedance close to one.
// What it prints: motion_peer.hpp.
//
// Its reader of XML limits how deep elements are nested, so that long chains are spread over included files. Contacts
// are disabled, and what a scene does not use is off.
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <sstream>
#include <utility>

#include "peers/motion_peer.hpp"

namespace {

using motion_peer::Angles;

struct Delete {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Model = std::unique_ptr<mjModel, Delete>;
using Data = std::unique_ptr<mjData, Delete>;
/// Of one model, by names; the first is the main one.
using Files = std::vector<std::pair<std::string, std::string>>;

struct Integrator {
  const char* name;
  int code;
};
constexpr Integrator integrators[] = {{"Euler", mjINT_EULER}, {"RK4", mjINT_RK4}, {"implicit", mjINT_IMPLICIT}};

Model load(const Files& files) {
  static mjVFS folder;  // large
  mj_defaultVFS(&folder);
  for (const auto& [name, text] : files) {
    mj_makeEmptyFileVFS(&folder, name.c_str(), static_cast<int>(text.size()));
    std::memcpy(folder.filedata[mj_findFileVFS(&folder, name.c_str())], text.data(), text.size());
  }
  char error[500] = "";
  Model model(mj_loadXML(files.front().first.c_str(), &folder, error, sizeof error));
  if (!model) std::fprintf(stderr, "peer_mujoco: %s\n", error);
  mj_deleteVFS(&folder);
  return model;
}

std::string header(const char* jacobian) {
  return std::string(
             "<mujoco><compiler angle=\"radian\" inertiafromgeom=\"false\"/>"
             "<size njmax=\"400\" nconmax=\"0\"/><option gravity=\"0 -9.81 0\" jacobian=\"") +
         jacobian + "\"><flag contact=\"disable\"/></option><worldbody>";
}

/// A rod whose frame sits at its inner pin; the element is to be closed.
std::string rod(const std::string& name, double x, double angle) {
  std::ostringstream xml;
  xml.precision(17);
  xml << "<body name=\"" << name << "\" pos=\"" << x << " 0 0\" euler=\"0 0 " << angle << "\">"
      << "<inertial pos=\"0.5 0 0\" mass=\"1\" diaginertia=\"1e-9 " << motion_peer::inertia << ' '
      << motion_peer::inertia << "\"/><joint type=\"hinge\" axis=\"0 0 1\"/>";
  return xml.str();
}

Files chain(int n, const char* jacobian) {
  constexpr int depth = 80;
  const auto file_of = [](int part) { return "part" + std::to_string(part) + ".xml"; };
  Files files;
  for (int first = 0; first < n; first += depth) {
    const int part = first / depth, last = std::min(n, first + depth);
    std::string xml = part == 0 ? header(jacobian) : "<mujocoinclude>";
    for (int k = first; k < last; ++k) xml += rod("b" + std::to_string(k), k == 0 ? 0 : 1, 0);
    if (last < n) xml += "<include file=\"" + file_of(part + 1) + "\"/>";
    for (int k = first; k < last; ++k) xml += "</body>";
    files.emplace_back(file_of(part), xml + (part == 0 ? "</worldbody></mujoco>" : "</mujocoinclude>"));
  }
  return files;
}

void accelerations() {
  for (const int n : {10, 100, 1000}) {
    const Model model = load(chain(n, "sparse"));
    if (!model) continue;
    const Data data(mj_makeData(model.get()));
    motion_peer::print_acceleration("MuJoCo", "mj_forward", n, [&](const Angles& q, const Angles& u) {
      mju_copy(data->qpos, q.data(), n);
      mju_copy(data->qvel, u.data(), n);
      mj_forward(model.get(), data.get());
      return Angles(data->qacc, data->qacc + n);
    });
  }
}

void falling_chain() {
  const Model model = load(chain(motion_peer::links, "dense"));
  if (!model) return;
  const Data data(mj_makeData(model.get()));
  for (const Integrator& integrator : integrators) {
    for (const double h : {1e-2, 2e-3, 5e-4, 1e-4}) {
      model->opt.integrator = integrator.code;
      model->opt.timestep = h;
      const long steps = std::lround(motion_peer::chain_duration / h);
      const motion_peer::Run run = motion_peer::fastest([&] {
        mj_resetData(model.get(), data.get());
        const double begin = bench::processor_time();
        for (long k = 0; k < steps; ++k) mj_step(model.get(), data.get());
        return motion_peer::Run{bench::processor_time() - begin, steps,
                                motion_peer::absolute({data->qpos, data->qpos + motion_peer::links})};
      });
      motion_peer::print_chain("MuJoCo", integrator.name, motion_peer::text("h=%g", h), run);
    }
  }
}

/// Cranks stand on the ground, and each but the last carries a coupler that is tied to the next.
Model four_bars(int n, double h) {
  std::string xml = header(n > 20 ? "sparse" : "dense");
  for (int k = 0; k <= n; ++k) {
    xml += rod("u" + std::to_string(k), k, mjPI / 2);
    if (k < n) xml += rod("h" + std::to_string(k), 1, -mjPI / 2) + "</body>";
    xml += "</body>";
  }
  xml += "</worldbody><equality>";
  for (int k = 0; k < n; ++k)
    xml += "<connect body1=\"h" + std::to_string(k) + "\" body2=\"u" + std::to_string(k + 1) +
           "\" anchor=\"1 0 0\" solref=\"" + motion_peer::text("%.17g", 2 * h) +
           " 1\" solimp=\"0.9999 0.9999 0.001\"/>";
  return load({{"scene.xml", xml + "</equality></mujoco>"}});
}

void four_bars_through_flat(int n, const Integrator& integrator, double h) {
  const Model model = four_bars(n, h);
  if (!model) return;
  const Data data(mj_makeData(model.get()));
  model->opt.integrator = integrator.code;
  model->opt.timestep = h;
  const auto freedom = [&](const std::string& body) {
    return model->body_dofadr[mj_name2id(model.get(), mjOBJ_BODY, body.c_str())];
  };
  for (int k = 0; k <= n; ++k) {
    const int crank = freedom("u" + std::to_string(k));
    data->qvel[crank] = -1;
    if (k < n) data->qvel[crank + 1] = 1;
  }
  const int first = freedom("u0");
  long made = 0;
  motion_peer::print_four_bars("MuJoCo", integrator.name, motion_peer::text("h=%g", h), n, [&](double t) {
    for (const long steps = std::lround(t / h); made < steps; ++made) mj_step(model.get(), data.get());
    return data->qpos[first] + mjPI / 2;
  });
}

}  // namespace

int main(int argc, char** argv) {
  const std::string scene = argc > 1 ? argv[1] : "";
  if (scene == "acceleration") {
    accelerations();
  } else if (scene == "chain") {
    falling_chain();
  } else if (scene == "fourbar") {
    for (const int n : {2, 40}) {
      for (const Integrator& integrator : integrators) {
        for (const double h : {1.25e-2, 5e-3, 1e-3, 2.5e-4}) four_bars_through_flat(n, integrator, h);
      }
    }
  } else {
    return motion_peer::unknown_scene;
  }
  return 0;
}
