// What the kernels of a batch compute from: the structure of one mechanism as plain lists, and the numbers of a group
// of designs, number after number, the designs of a group beside each other.
//
//   Phi(q, t) = 0     Newton-Raphson, every lane its own      Phi_q qd = nu      Phi_q qdd = gamma
//   Phi_q^T lambda = Q - M qdd      where loads are wanted
//
// Phi_q is eliminated in steps that are listed once for all designs (lane_elimination.hpp); what is left of its
// diagonal blocks are tails, small dense matrices whose rows are exchanged lane by lane.
//
// Kernels are compiled once for every instruction set: they see nothing but these plain pointers, and no function of
// theirs can take the place of another part's. Units: m, rad, s, kg, N.
#pragma once

namespace catena {

/// Designs of a group; every number of a group is stored as so many values side by side: two packs of the widest
/// instruction set.
inline constexpr int lane_count = 16;

/// Constraint types that are evaluated in lanes: those whose equations are formulas without a search or a case.
#define CATENA_LANE_ELEMENTS(X) \
  X(AbsoluteAngle)              \
  X(AbsoluteDistance)           \
  X(AbsoluteX)                  \
  X(AbsoluteY)                  \
  X(Belt)                       \
  X(Coupler)                    \
  X(Displacement)               \
  X(Gear)                       \
  X(RackPinion)                 \
  X(RelativeAngle)              \
  X(RelativeDistance)           \
  X(RelativeX)                  \
  X(RelativeY)                  \
  X(Revolute)                   \
  X(Slot)                       \
  X(Translational)              \
  X(Weld)

#define CATENA_LANE_NAME(Type) Type##_in_lanes,
enum LaneType { CATENA_LANE_ELEMENTS(CATENA_LANE_NAME) lane_types };
#undef CATENA_LANE_NAME

class LaneSearches;
/// What is asked of constraints that are evaluated lane by lane (lane_searches.hpp).
enum class LaneSearch { residual, jacobian, gamma };

/// Force types that are evaluated in lanes; springs without a curve.
#define CATENA_LANE_FORCES(X) \
  X(Bushing)                  \
  X(ElasticCable)             \
  X(JointDamper)              \
  X(PointForce)               \
  X(SpringDamper)             \
  X(Torque)                   \
  X(TorsionSpring)

#define CATENA_LANE_NAME(Type) Type##_in_lanes,
enum LaneForceType { CATENA_LANE_FORCES(CATENA_LANE_NAME) lane_force_types };
#undef CATENA_LANE_NAME

/// Largest tail of a block: 2 in a loop of links.
inline constexpr int largest_tail = 6;

struct LaneElement {
  int row, body_i, body_j;  ///< first row; frames
  int field;                ///< place of its first parameter
  int function;             ///< place of c, c', c'' in `function`; -1: it has none
  int scale;                ///< place of its factor in `field`; -1: 1
  int first_place;          ///< of its varying entries, in `place`
  int choice;               ///< its flag, or its side: the same in all designs
  bool timed;               ///< c may change with time
};

struct LaneForce {
  int body_i, body_j;  ///< frames
  int field;           ///< place of its first parameter
  int function;        ///< place of its first value, and two rates, in `function`; -1: it has none
  int choice;
};

/// So many elements of one type.
struct LaneElements {
  LaneType type;
  int count;
};
struct LaneForces {
  LaneForceType type;
  int count;
};

/// What a step does to its target t, with a source s and a factor m: an entry of Phi_q.
enum class LaneAct {
  add_product,       ///< t + m s
  subtract_product,  ///< t - m s
  solve_tail         ///< of the numbers in the rows of a tail
};

/// Places are those of values: a slot or a row times lane_count.
struct LaneStep {
  int target, source, factor;
};

/// Steps that do the same, one after the other; of solve_tail `first` is the number of the tail.
struct LaneRun {
  LaneAct act;
  int first, last;
};

/// Rows, and slots row by row.
struct LaneTail {
  int size;
  int row[largest_tail];
  int slot[largest_tail * largest_tail];
  bool length_column[largest_tail], length_row[largest_tail];
};

/// A slot that no element writes and steps change: what it begins with.
struct LaneReset {
  int place;
  double value;
};

/// An unknown takes the place of the row in which its pivot stands.
struct LaneUnknown {
  int place;       ///< of that row
  int coordinate;  ///< its own place in q
};

/// What loads are summed from; where none are wanted there are none.
struct LaneLoadCode {
  const LaneForce* force;  ///< type after type
  const LaneForces* of_type;
  int types;            ///< that have forces
  int masses, gravity;  ///< places in `field`: of mass and inertia, body after body; of two components
};

struct LaneCode {
  int moving, frames, rows, slots;  ///< frames: of moving bodies, of those that stand still, of the ground
  const LaneElement* element;       ///< type after type
  const LaneElements* of_type;
  int types;         ///< that have elements
  const int* place;  ///< in the matrix, of the varying entries of elements
  int factor_runs, solve_runs, transposed_runs, resets, tails;
  /// Of Phi_q, in which all places of steps are; of a right-hand side; of one of the transposed equations.
  const LaneRun *factor, *solve, *transposed;
  const LaneStep* step;
  const LaneReset* reset;
  const LaneTail* tail;
  const LaneUnknown* unknown;  ///< lengths, then angles
  int lengths;
  const int* searched;  ///< rows that are evaluated lane by lane, all of them lengths
  int searched_rows;
  LaneLoadCode loads;
};

/// What a solve tells of every lane.
struct LaneFindings {
  double* converged;    ///< 1 or 0
  double* first_size;   ///< of the first correction, rad or length scales
  double* first_turn;   ///< its largest angle, rad
  double* contraction;  ///< largest ratio of successive corrections above rounding
  double* residual;     ///< rad or length scales
  double* margin;       ///< tail after tail: its determinant in rad and length scales
};

/// One group at one instant. Arrays hold lane_count values a number and are aligned to 64 bytes.
struct LaneJob {
  const LaneCode* code;
  const double* field;
  const double* function;  ///< c, c', c'' of every element that has a value
  const double* unit;      ///< one over the length scale
  double* frame;           ///< x, y, phi, cos, sin of every frame; those after the moving ones are given
  double *q, *qd, *qdd;    ///< of the moving bodies; q: the start of Newton's iteration
  const double* applied;   ///< forces that no kernel computes, of the moving bodies
  double* load;            ///< Q - M qdd of the moving bodies
  double* lambda;          ///< rows
  double* turned;          ///< cosine and sine of the moving bodies at the configuration
  double *matrix, *right;  ///< slots, those of constants filled; scratch: rows
  double *tail, *exchange;
  /// Evaluates searched rows into `right`, and their entries into `matrix`, in so many lanes from the first on.
  void (*search)(const LaneJob& job, LaneSearch what, int first, int count);
  LaneSearches* searches;
  int lanes;  ///< in use; packs beyond them are left out
  bool velocity, acceleration;
  double tolerance;  ///< of residuals, relative to the length scale
  LaneFindings found;
};

/// Positions foretold from two instants at which positions and rates are known: the quintic of Hermite through both.
///   u = (t - t0) / h        h = t1 - t0        where h = 0: u = 1
/// And whether a determinant, going on as it went from the first to the second, would lose too much of itself.
struct LaneForetelling {
  int numbers, tails;
  const double *t0, *t1, *t;
  const double *q0, *qd0, *qdd0, *q1, *qd1, *qdd1;
  const double *margin0, *margin1;
  double remaining_part;  ///< of a determinant
  double* q;
  double* falls;  ///< 1 or 0
};

/// Whether the step from one instant to the next is one that Kinematics would take, by what solve() left.
struct LaneJudgement {
  int numbers, tails;
  const double *q0, *q, *margin0, *margin;
  const double *converged, *first_turn, *contraction;
  double largest_turn, largest_contraction, longest_step, sudden_part;
  double* sound;  ///< 1 or 0
};

/// Whether a determinant is below a part of the largest that it was, or of 1.
struct LaneWatch {
  int tails;
  double least_part;
  const double* margin;
  double* largest;  ///< goes on
  double* near;     ///< 1 or 0
};

struct LaneStaticKernels;

struct LaneKernels {
  const char* name;  ///< of the instruction set
  void (*solve)(LaneJob&);
  /// Multipliers at the configuration, with the rates and the factors that solve() left.
  void (*find_loads)(LaneJob&);
  // Whether any lane falls, all lanes are sound, any lane is near:
  bool (*foretell)(const LaneForetelling&);
  bool (*judge)(const LaneJudgement&);
  bool (*watch)(const LaneWatch&);
  const LaneStaticKernels* statics;  ///< of equilibria (lane_static_code.hpp)
};

}  // namespace catena
