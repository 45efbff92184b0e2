// What the kernels of a batch compute from: the structure of one mechanism as plain lists, and the numbers of a group
// of designs, number after number, the designs of a group beside each other.
//
//   Phi(q, t) = 0     Newton-Raphson, every lane its own      Phi_q qd = nu      Phi_q qdd = gamma
//
// Phi_q falls into diagonal blocks (block triangular form, the last one is solved first). In a block every entry that
// is +1 or -1 whatever the design is a pivot that cannot vanish: they are eliminated first. What is left, the tail, is
// a small dense matrix whose rows are exchanged lane by lane (partial pivoting): its determinant is that of the block,
// up to its sign, and vanishes where the block is singular.
//
// Kernels are compiled once for every instruction set: they see nothing but these plain pointers, and no function of
// theirs can take the place of another part's. Units: m, rad, s.
#pragma once

namespace catena {

/// Designs of a group; every number of a group is stored as so many values side by side.
inline constexpr int lane_count = 8;

/// Constraint types that are evaluated in lanes: those whose equations are formulas without a search or a case.
#define CATENA_LANE_ELEMENTS(X) \
  X(AbsoluteAngle)              \
  X(AbsoluteDistance)           \
  X(AbsoluteX)                  \
  X(AbsoluteY)                  \
  X(Coupler)                    \
  X(Displacement)               \
  X(RelativeAngle)              \
  X(RelativeDistance)           \
  X(RelativeX)                  \
  X(RelativeY)                  \
  X(Revolute)                   \
  X(Slot)                       \
  X(Translational)              \
  X(Weld)

#define CATENA_LANE_COUNT(Type) +1
inline constexpr int lane_types = 0 CATENA_LANE_ELEMENTS(CATENA_LANE_COUNT);
#undef CATENA_LANE_COUNT

/// Largest tail of a block: 2 in a loop of links.
inline constexpr int largest_tail = 6;

struct LaneElement {
  int row, body_i, body_j;  ///< first row; frames
  int field;                ///< place of its first parameter
  int function;             ///< place of c, c', c'' in `function`; -1: it has none
  int scale;                ///< place of its factor in `field`; -1: 1
  int slot;                 ///< place of its first varying entry in `slot`
  bool timed;               ///< c may change with time
};

/// A pivot +1 or -1. Lists begin at `list`: of the entries below it their slots and rows, of those to the right of it
/// their slots and rows (of the pivots of their columns), then the slots of all products.
struct LanePivot {
  int row, below, right, list;
  double inverse;
};

/// Rows, and slots row by row.
struct LaneTail {
  int size;
  int row[largest_tail];
  int slot[largest_tail * largest_tail];
  bool length_column[largest_tail], length_row[largest_tail];
};

struct LaneBlock {
  int first_pivot, pivots;
  int tail;           ///< -1: none
  int first_outside;  ///< entries in rows of earlier blocks: slot, row there, row of the pivot of its column
  int outside;
};

struct LaneCode {
  int moving, frames, rows, slots;  ///< frames: of moving bodies, of those that stand still, of the ground
  double origin_x, origin_y;        ///< of all frames, in the ground frame
  const LaneElement* element;
  int first_of_type[lane_types + 1];
  const int* slot;
  const double* initial;  ///< of every slot: the entries +1 and -1, else zero
  int blocks, tails;
  const LaneBlock* block;
  const LanePivot* pivot;
  const int* list;
  const LaneTail* tail;
  const int* outside;
  const int* coordinate;  ///< of the unknown whose pivot stands in a row
};

/// One group at one instant. Arrays hold lane_count values a number and are aligned to 64 bytes.
struct LaneJob {
  const LaneCode* code;
  const double* field;
  const double* function;  ///< c, c', c'' of every element that has a value
  const double* unit;      ///< one over the length scale
  double* frame;           ///< x, y, phi, cos, sin of every frame; those after the moving ones are given
  double *q, *qd, *qdd;    ///< of the moving bodies; q: the start of Newton's iteration
  double *matrix, *right;  ///< scratch: slots, rows
  double *tail, *exchange;
  int lanes;  ///< in use; packs beyond them are left out
  bool velocity, acceleration;
  double tolerance;  ///< of residuals, relative to the length scale
  // Of every lane:
  double* converged;    ///< 1 or 0
  double* first_size;   ///< of the first correction, rad or length scales
  double* first_turn;   ///< its largest angle, rad
  double* contraction;  ///< largest ratio of successive corrections above rounding
  double* residual;     ///< rad or length scales
  double* margin;       ///< tail after tail: its determinant in rad and length scales
};

/// Positions foretold from two instants at which positions and rates are known: the quintic of Hermite through both.
///   u = (t - t0) / (t1 - t0)        h = t1 - t0
struct LaneForetelling {
  int numbers;
  const double *q0, *qd0, *qdd0, *q1, *qd1, *qdd1;
  const double *u, *h;
  double* q;
};

struct LaneKernels {
  const char* name;  ///< of the instruction set
  void (*solve)(LaneJob&);
  void (*foretell)(const LaneForetelling&);
};

}  // namespace catena
