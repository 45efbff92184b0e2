// Siconos (Moreau-Jean time stepping: impacts and friction as one complementarity problem a step) on the problems of
// contact; what it prints: contact_peer.hpp. Chains are left out: its planar friction solvers take no pins.
#include <SolverOptions.h>

#include <SiconosKernel.hpp>
#include <cstring>
#include <memory>
#include <vector>

#include "peers/contact_peer.hpp"

namespace {

struct Settings {
  double theta;
};

/// Gap and slip of a disc on the floor, its centre at (arm, 0) of the body.
class OnFloor : public LagrangianScleronomousR {
 public:
  OnFloor(double arm, double radius) : arm_(arm), radius_(radius) { _jachq = std::make_shared<SimpleMatrix>(2, 3); }
  void computeh(const BlockVector& q, BlockVector&, SiconosVector& y) override {
    y.setValue(0, q.getValue(1) + arm_ * std::sin(q.getValue(2)) - radius_);
    y.setValue(1, 0);
  }
  void computeJachq(const BlockVector& q, BlockVector&) override {
    const double c = std::cos(q.getValue(2)), s = std::sin(q.getValue(2));
    const double rows[2][3] = {{0, 1, arm_ * c}, {1, 0, radius_ - arm_ * s}};
    for (unsigned r = 0; r < 2; ++r) {
      for (unsigned k = 0; k < 3; ++k) _jachq->setValue(r, k, rows[r][k]);
    }
  }

 private:
  double arm_, radius_;
};

class World {
 public:
  World(const Settings& settings, double restitution, double friction)
      : settings_(settings),
        system_(std::make_shared<NonSmoothDynamicalSystem>(0, 1e3)),
        law_(std::make_shared<NewtonImpactFrictionNSL>(restitution, 0, friction, 2)) {}

  void add_ball(double x, double y, double radius, double mass) {
    add_body(x, y, 0, 0, mass, 0.4 * mass * radius * radius);
    touch(0, radius);
  }
  void add_dumbbell(double x, double y, double angle, double spin, double half_length, double radius, double mass,
                    double inertia) {
    add_body(x, y, angle, spin, mass, inertia);
    for (const int end : {1, -1}) touch(end * half_length, radius);
  }
  void add_block(double x, double half_size, double mass) {
    add_body(x, half_size, 0, 0, mass, 1e9 * mass);
    touch(0, half_size);
  }

  void ready(double h) {
    auto solver = std::make_shared<FrictionContact>(2);
    solver->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = 1e-12;
    simulation_ = std::make_shared<TimeStepping>(system_, std::make_shared<TimeDiscretisation>(0, h),
                                                 std::make_shared<MoreauJeanOSI>(settings_.theta), solver);
    simulation_->setNewtonTolerance(1e-11);
    simulation_->setNewtonMaxIteration(5);  // where rounding is larger than that
  }
  void push(int body, double force) { loads_[static_cast<std::size_t>(body)]->setValue(0, force); }
  void step(double) {
    simulation_->computeOneStep();
    simulation_->nextStep();
  }
  double x(int body) const { return place(body, 0); }
  double y(int body) const { return place(body, 1); }
  double angle(int body) const { return place(body, 2); }

 private:
  double place(int body, unsigned coordinate) const {
    return bodies_[static_cast<std::size_t>(body)]->q()->getValue(coordinate);
  }
  void add_body(double x, double y, double angle, double spin, double mass, double inertia) {
    auto q = std::make_shared<SiconosVector>(3), v = std::make_shared<SiconosVector>(3);
    auto load = std::make_shared<SiconosVector>(3);
    auto M = std::make_shared<SimpleMatrix>(3, 3);
    q->setValue(0, x);
    q->setValue(1, y);
    q->setValue(2, angle);
    v->setValue(2, spin);
    load->setValue(1, -mass * bench::contact_gravity);
    M->setValue(0, 0, mass);
    M->setValue(1, 1, mass);
    M->setValue(2, 2, inertia);
    bodies_.push_back(std::make_shared<LagrangianLinearTIDS>(q, v, M));
    bodies_.back()->setFExtPtr(load);
    loads_.push_back(load);
    system_->insertDynamicalSystem(bodies_.back());
  }
  /// A disc of the last body.
  void touch(double arm, double radius) {
    system_->link(std::make_shared<Interaction>(law_, std::make_shared<OnFloor>(arm, radius)), bodies_.back());
  }

  Settings settings_;
  std::shared_ptr<NonSmoothDynamicalSystem> system_;
  std::shared_ptr<NonSmoothLaw> law_;
  std::vector<std::shared_ptr<LagrangianLinearTIDS>> bodies_;
  std::vector<std::shared_ptr<SiconosVector>> loads_;
  std::shared_ptr<TimeStepping> simulation_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "contact") != 0) return 2;
  for (const double theta : {0.5, 1.0})
    contact_peer::run<World>("Siconos", theta == 1 ? "Moreau-Jean, theta 1" : "Moreau-Jean, theta 1/2",
                             Settings{theta});
}
