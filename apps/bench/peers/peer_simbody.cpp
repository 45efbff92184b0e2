// Simbody on motions without contact: joint coordinates, articulated bodies, loops closed by constraints onto which
// every step is projected, which costs less than larger steps do and keeps A02 on its branch. What it prints:
// motion_peer.hpp.
//
// Frames sit at the inner pins, the case that the library specialises. A pin that closes a loop is a pair of
// PointInPlane constraints: a Ball would add a redundant equation.
#include <Simbody.h>

#include <functional>
#include <memory>

#include "peers/motion_peer.hpp"

namespace {

using namespace SimTK;
using motion_peer::Angles;

struct Mechanism {
  MultibodySystem system;
  SimbodyMatterSubsystem matter{system};
  GeneralForceSubsystem forces{system};
  std::vector<MobilizedBody> bodies;

  MobilizedBody& add_pin(MobilizedBody parent, const Vec3& at, const Body& body) {
    bodies.push_back(MobilizedBody::Pin(parent, Transform(at), body, Transform()));
    return bodies.back();
  }
  void close(MobilizedBody& base, const Vec3& on_base, MobilizedBody& other, const Vec3& on_other) {
    Constraint::PointInPlane(base, UnitVec3(1, 0, 0), on_base[0], other, on_other);
    Constraint::PointInPlane(base, UnitVec3(0, 1, 0), on_base[1], other, on_other);
  }
};

Body::Rigid body(double mass, double inertia, const Vec3& centre) {
  return Body::Rigid(
      MassProperties(mass, centre, Inertia(inertia, inertia, inertia).shiftFromMassCenter(centre, mass)));
}
Body::Rigid rod() { return body(1, motion_peer::inertia, Vec3(0.5, 0, 0)); }

std::unique_ptr<Mechanism> chain(int n) {
  auto made = std::make_unique<Mechanism>();
  Force::UniformGravity(made->forces, made->matter, Vec3(0, -motion_peer::gravity, 0));
  MobilizedBody parent = made->matter.Ground();
  for (int k = 0; k < n; ++k) parent = made->add_pin(parent, Vec3(k == 0 ? 0 : 1, 0, 0), rod());
  return made;
}

Vector from(const Angles& v) { return Vector(static_cast<int>(v.size()), v.data()); }
Angles to_angles(const Vector& v) { return {&v[0], &v[0] + v.size()}; }

void accelerations() {
  for (const int n : {10, 100, 1000, 10000}) {
    const auto made = chain(n);
    State state = made->system.realizeTopology();
    made->system.realizeModel(state);
    motion_peer::print_acceleration("Simbody", "articulated bodies", n, [&](const Angles& q, const Angles& u) {
      state.updQ() = from(q);
      state.updU() = from(u);
      made->system.realize(state, Stage::Acceleration);
      return to_angles(state.getUDot());
    });
  }
}

struct Method {
  const char* name;
  std::function<std::unique_ptr<Integrator>(const MultibodySystem&)> make;
};
template <class T>
Method method(const char* name) {
  return {name, [](const MultibodySystem& system) { return std::make_unique<T>(system); }};
}
const Method merson = method<RungeKuttaMersonIntegrator>("RungeKuttaMerson");
const Method fehlberg = method<RungeKuttaFeldbergIntegrator>("RungeKuttaFeldberg");
const Method adams = {"CPodes Adams", [](const MultibodySystem& system) {
                        return std::make_unique<CPodesIntegrator>(system, CPodes::Adams, CPodes::Functional);
                      }};

/// stepTo() returns at the start of a run and at its end too.
void go_to(Integrator& integrator, double t) {
  while (integrator.getTime() < t && integrator.stepTo(t) != Integrator::EndOfSimulation) {
  }
}

void project_every_step(Integrator& integrator, double accuracy) {
  integrator.setConstraintTolerance(std::min(1e-9, 0.1 * accuracy));
  integrator.setProjectEveryStep(true);
}

/// From the state `start` to `until`; the angles of the joints.
motion_peer::Run run(const Method& method, const Mechanism& mechanism, const State& start, double accuracy,
                     double until, bool has_loops) {
  const double begin = bench::processor_time();
  const auto integrator = method.make(mechanism.system);
  integrator->setAccuracy(accuracy);
  if (has_loops) project_every_step(*integrator, accuracy);
  integrator->setFinalTime(until);
  integrator->initialize(start);
  go_to(*integrator, until);
  const double seconds = bench::processor_time() - begin;
  return {seconds, integrator->getNumStepsTaken(), to_angles(integrator->getState().getQ())};
}

void falling_chain() {
  const auto made = chain(motion_peer::links);
  const State start = made->system.realizeTopology();
  for (const Method& method : {merson, fehlberg, adams}) {
    for (const double accuracy : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
      motion_peer::Run best =
          motion_peer::fastest([&] { return run(method, *made, start, accuracy, motion_peer::chain_duration, false); });
      best.angles = motion_peer::absolute(best.angles);
      motion_peer::print_chain("Simbody", method.name, motion_peer::text("%.0e", accuracy), best);
    }
  }
}

/// Coupler k hangs on crank k and is tied to the top of the next.
void four_bars_through_flat(int n, const Method& method, double accuracy) {
  Mechanism made;
  Force::UniformGravity(made.forces, made.matter, Vec3(0, -motion_peer::gravity, 0));
  const Vec3 end(1, 0, 0);
  for (int k = 0; k <= n; ++k) made.add_pin(made.matter.Ground(), Vec3(k, 0, 0), rod());
  for (int k = 0; k < n; ++k) {
    MobilizedBody coupler = made.add_pin(made.bodies[static_cast<std::size_t>(k)], end, rod());
    made.close(made.bodies[static_cast<std::size_t>(k) + 1], end, coupler, end);
  }
  State start = made.system.realizeTopology();
  for (int k = 0; k < 2 * n + 1; ++k) {
    const double sign = k <= n ? 1 : -1;
    made.bodies[static_cast<std::size_t>(k)].setOneQ(start, 0, sign * Pi / 2);
    made.bodies[static_cast<std::size_t>(k)].setOneU(start, 0, -sign);
  }
  const auto integrator = method.make(made.system);
  integrator->setAccuracy(accuracy);
  project_every_step(*integrator, accuracy);
  integrator->initialize(start);
  motion_peer::print_four_bars(
      "Simbody", method.name, motion_peer::text("%.0e", accuracy), n,
      [&](double t) {
        go_to(*integrator, t);
        return made.bodies[0].getOneQ(integrator->getState(), 0);
      },
      10);
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
      for (const Method& method : {merson, fehlberg}) {
        for (const double accuracy : {1e-4, 1e-5, 1e-6, 1e-7, 1e-9}) {
          if (n == 40 && accuracy < 1e-4) break;  // more than five seconds each
          try {
            four_bars_through_flat(n, method, accuracy);
          } catch (const std::exception&) {
            std::fprintf(stderr, "peer_simbody: %d four-bars, %s at %g: it gives up\n", n, method.name, accuracy);
          }
        }
      }
    }
  } else {
    return motion_peer::unknown_scene;
  }
  return 0;
}
