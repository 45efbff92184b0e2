// MuJoCo on the problems of contact: joint coordinates, soft contacts. What it prints: contact_peer.hpp.
//
// A bounce is that of a spring and a damper which push only, stiff for the step: of the contact's r'' + 2 z w r' + w^2
// r = 0, a share e of the speed, where
//   -log e = z / s (pi - atan2(2 z s, 1 - 2 z^2)),   s = sqrt(1 - z^2)
// is left (T. Schwager, T. Poeschel, Granular Matter 9 (2007), 465-469). Friction: elliptic cones, tangential rows a
// hundred times as hard as normal ones. The block's spring is one of its joint: pushes are not needed.
#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <sstream>
#include <vector>

#include "peers/contact_peer.hpp"

namespace {

struct Settings {
  int integrator;
  double hardness;  // w h
};

double damping_ratio(double restitution) {
  double low = 0, high = 0.999;
  for (int halving = 0; halving < 60; ++halving) {
    const double z = (low + high) / 2, s = std::sqrt(1 - z * z);
    const double lost = z / s * (3.14159265358979323846 - std::atan2(2 * z * s, 1 - 2 * z * z));
    (lost < -std::log(restitution) ? low : high) = z;
  }
  return low;
}

class World {
 public:
  World(const Settings& settings, double restitution, double friction)
      : settings_(settings), restitution_(restitution), friction_(friction) {
    bodies_.precision(17);
  }

  void add_ball(double x, double y, double radius, double mass) {
    open(x, y, 0, mass, 0.4 * mass * radius * radius, "");
    bodies_ << "<geom type=\"sphere\" size=\"" << radius << "\" contype=\"1\" conaffinity=\"0\"/></body>";
  }
  void add_dumbbell(double x, double y, double angle, double spin, double half_length, double radius, double mass,
                    double inertia) {
    open(x, y, spin, mass, inertia, "");
    angles_.back() = angle;
    for (const int end : {1, -1})
      bodies_ << "<geom type=\"sphere\" size=\"" << radius << "\" pos=\"" << end * half_length
              << " 0 0\" contype=\"1\" conaffinity=\"0\"/>";
    bodies_ << "</body>";
  }
  void add_block(double x, double half_size, double mass) {
    open(0, half_size, 0, mass, 1e6 * mass, " stiffness=\"100\"");
    starts_.back() = x;
    bodies_ << "<geom type=\"box\" size=\"" << half_size << ' ' << half_size << ' ' << half_size
            << "\" contype=\"1\" conaffinity=\"0\"/></body>";
  }
  /// One body in another: hinges are joint coordinates.
  void add_link(double x, double y, double speed, double half_length, double radius, double mass, double inertia) {
    if (links_++ == 0) {
      open(x, y, 0, mass, inertia, "");
      speed_ = speed;
    } else {
      bodies_ << "<body pos=\"" << 2 * half_length << " 0 0\"><joint type=\"hinge\" axis=\"0 0 1\" pos=\""
              << -half_length << " 0 0\"/>";
      add_mass(mass, inertia);
    }
    for (const int end : {1, -1})
      bodies_ << "<geom type=\"sphere\" size=\"" << radius << "\" pos=\"" << end * half_length
              << " 0 0\" contype=\"1\" conaffinity=\"0\"/>";
  }

  void ready(double h) {
    for (int k = 0; k < links_; ++k) bodies_ << "</body>";
    build(h);
  }
  void push(int, double) {}
  void step(double) { mj_step(model_.get(), data_.get()); }
  double x(int body) const {
    if (links_ == 0) return origins_[body].x + data_->qpos[3 * body];
    mj_kinematics(model_.get(), data_.get());
    return data_->xpos[3 * (body + 1)];  // after the world
  }
  double y(int body) const { return origins_[body].y + data_->qpos[3 * body + 1]; }
  double angle(int body) const { return data_->qpos[3 * body + 2]; }

 private:
  struct ModelDeleter {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
  };
  struct DataDeleter {
    void operator()(mjData* d) const { mj_deleteData(d); }
  };

  void open(double x, double y, double spin, double mass, double inertia, const std::string& spring) {
    bodies_ << "<body pos=\"" << x << ' ' << y << " 0\"><joint type=\"slide\" axis=\"1 0 0\"" << spring
            << "/><joint type=\"slide\" axis=\"0 1 0\"/><joint type=\"hinge\" axis=\"0 0 1\"/>";
    add_mass(mass, inertia);
    origins_.push_back({x, y});
    starts_.push_back(0);
    angles_.push_back(0);
    spins_.push_back(spin);
  }

  void add_mass(double mass, double inertia) {
    bodies_ << "<inertial pos=\"0 0 0\" mass=\"" << mass << "\" diaginertia=\"" << inertia << ' ' << inertia << ' '
            << inertia << "\"/>";
  }

  void build(double h) {
    const double w = settings_.hardness / h, z = restitution_ > 0 ? damping_ratio(restitution_) : 1;
    std::ostringstream xml;
    xml.precision(17);
    xml << "<mujoco><compiler angle=\"radian\"/><size njmax=\"400\" nconmax=\"100\"/><option cone=\"elliptic\" "
        << "impratio=\"100\" jacobian=\"sparse\" tolerance=\"1e-12\" timestep=\"" << h << "\" gravity=\"0 "
        << -bench::contact_gravity << " 0\"/><default><geom condim=\"" << (friction_ > 0 ? 3 : 1) << "\" friction=\""
        << friction_ << " 0 0\" solimp=\"0.9999 0.9999 0.001\" solref=\"" << -w * w << ' ' << -2 * z * w
        << "\"/></default><worldbody><geom type=\"plane\" size=\"0 0 1\" zaxis=\"0 1 0\" contype=\"0\" "
           "conaffinity=\"1\"/>"
        << bodies_.str() << "</worldbody></mujoco>";
    const std::string text = xml.str();
    static mjVFS files;  // large: not on the stack
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "contact.xml", static_cast<int>(text.size()));
    std::memcpy(files.filedata[mj_findFileVFS(&files, "contact.xml")], text.data(), text.size());
    char error[500] = "";
    model_.reset(mj_loadXML("contact.xml", &files, error, sizeof error));
    mj_deleteVFS(&files);
    if (!model_) {
      std::fprintf(stderr, "%s\n", error);
      std::exit(1);
    }
    model_->opt.integrator = settings_.integrator;
    data_.reset(mj_makeData(model_.get()));
    for (std::size_t k = 0; k < angles_.size(); ++k) {
      data_->qpos[3 * k] = starts_[k];
      data_->qpos[3 * k + 2] = angles_[k];
      data_->qvel[3 * k + 2] = spins_[k];
    }
    if (links_ > 0) data_->qvel[0] = speed_;
  }

  Settings settings_;
  double restitution_, friction_;
  std::ostringstream bodies_;
  std::vector<bench::Ball> origins_;
  std::vector<double> starts_, angles_, spins_;
  int links_ = 0;     // of a chain
  double speed_ = 0;  // along x
  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::unique_ptr<mjData, DataDeleter> data_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "contact") != 0) return 2;
  mju_user_warning = [](const char*) {};  // it would write a file
  for (const auto& [hardness, name] : {std::pair{0.2, ", w h = 0.2"}, std::pair{0.02, ", w h = 0.02"}}) {
    contact_peer::run<World>("MuJoCo", std::string("Euler") + name, Settings{mjINT_EULER, hardness});
    contact_peer::run<World>("MuJoCo", std::string("RK4") + name, Settings{mjINT_RK4, hardness});
  }
}
