// Bullet (float64 build) on the problems of contact: rigid bodies under sequential impulses or the Dantzig direct
// solver, kept in the plane by their factors of motion. What it prints: contact_peer.hpp.
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <cstring>
#include <memory>
#include <vector>

#include "peers/contact_peer.hpp"

static_assert(sizeof(btScalar) == sizeof(double), "build with BT_USE_DOUBLE_PRECISION and the -float64 libraries");

namespace {

struct Settings {
  bool direct;
};

class World {
 public:
  World(const Settings& settings, double restitution, double friction)
      : restitution_(restitution), friction_(friction) {
    if (settings.direct)
      solver_ = std::make_unique<btMLCPSolver>(&dantzig_);
    else
      solver_ = std::make_unique<btSequentialImpulseConstraintSolver>();
    world_ = std::make_unique<btDiscreteDynamicsWorld>(&dispatcher_, &broadphase_, solver_.get(), &configuration_);
    world_->setGravity(btVector3(0, -bench::contact_gravity, 0));
    btContactSolverInfo& info = world_->getSolverInfo();
    info.m_restitutionVelocityThreshold = 0;
    info.m_splitImpulse = 0;
    info.m_erp = info.m_erp2 = 0;  // it moves bodies out of each other by speeds, which a bounce would keep
    add_body(own(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0)), 0, btVector3(0, 0, 0),
             btTransform::getIdentity());
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    for (const auto& pin : pins_) world_->removeConstraint(pin.get());
    for (const auto& body : bodies_) world_->removeRigidBody(body.get());
  }

  void add_ball(double x, double y, double radius, double mass) {
    const double inertia = 0.4 * mass * radius * radius;
    add_body(own(std::make_unique<btSphereShape>(radius)), mass, btVector3(inertia, inertia, inertia), at(x, y, 0));
  }
  void add_dumbbell(double x, double y, double angle, double spin, double half_length, double radius, double mass,
                    double inertia) {
    auto both = std::make_unique<btCompoundShape>();
    for (const int end : {1, -1})
      both->addChildShape(at(end * half_length, 0, 0), own(std::make_unique<btSphereShape>(radius)));
    add_body(own(std::move(both)), mass, btVector3(inertia, inertia, inertia), at(x, y, angle));
    bodies_.back()->setAngularVelocity(btVector3(0, 0, spin));
  }
  void add_block(double x, double half_size, double mass) {
    auto box = std::make_unique<btBoxShape>(btVector3(half_size, half_size, half_size));
    box->setMargin(0);
    add_body(own(std::move(box)), mass, btVector3(mass, mass, mass), at(x, half_size, 0));
    bodies_.back()->setAngularFactor(btVector3(0, 0, 0));
  }
  void add_link(double x, double y, double speed, double half_length, double radius, double mass, double inertia) {
    add_dumbbell(x, y, 0, 0, half_length, radius, mass, inertia);
    bodies_.back()->setLinearVelocity(btVector3(speed, 0, 0));
    if (bodies_.size() == 2) return;  // the floor and this
    pins_.push_back(std::make_unique<btPoint2PointConstraint>(
        *bodies_[bodies_.size() - 2], *bodies_.back(), btVector3(half_length, 0, 0), btVector3(-half_length, 0, 0)));
    world_->addConstraint(pins_.back().get(), true);
  }

  void ready(double) {}
  void push(int body, double force) { moving(body).applyCentralForce(btVector3(force, 0, 0)); }
  void step(double h) { world_->stepSimulation(h, 0); }
  double x(int body) const { return moving(body).getWorldTransform().getOrigin().x(); }
  double y(int body) const { return moving(body).getWorldTransform().getOrigin().y(); }
  double angle(int body) const {
    const btMatrix3x3& turned = moving(body).getWorldTransform().getBasis();
    return std::atan2(turned[1][0], turned[0][0]);
  }

 private:
  static btTransform at(double x, double y, double angle) {
    return btTransform(btQuaternion(btVector3(0, 0, 1), angle), btVector3(x, y, 0));
  }
  btCollisionShape* own(std::unique_ptr<btCollisionShape> shape) {
    shapes_.push_back(std::move(shape));
    return shapes_.back().get();
  }
  /// The floor is the first of them.
  btRigidBody& moving(int body) const { return *bodies_[static_cast<std::size_t>(body) + 1]; }
  void add_body(btCollisionShape* shape, double mass, const btVector3& inertia, const btTransform& place) {
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
    info.m_startWorldTransform = place;
    info.m_restitution = mass > 0 ? restitution_ : 1;
    info.m_friction = std::sqrt(friction_);  // of a pair: the product
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    // Before bodies touch it would take a part of the approach away, and with it of the bounce.
    bodies_.back()->setContactProcessingThreshold(0);
    bodies_.back()->setLinearFactor(btVector3(1, 1, 0));
    bodies_.back()->setAngularFactor(btVector3(0, 0, 1));
    world_->addRigidBody(bodies_.back().get());
  }

  double restitution_, friction_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDantzigSolver dantzig_;
  std::unique_ptr<btConstraintSolver> solver_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btDiscreteDynamicsWorld> world_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> pins_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "contact") != 0) return 2;
  contact_peer::run<World>("Bullet", "sequential impulses", Settings{false});
  contact_peer::run<World>("Bullet", "Dantzig", Settings{true});
}
