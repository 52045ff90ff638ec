// What a step takes and what it gives: State, Inputs, Reaction, Report.
#pragma once

#include <slideway/scene.hpp>

namespace slideway {

/// What ends a mode.
enum class EventKind : unsigned char {
  slip_reversal,   ///< a sliding guide turns back without resting
  stick,           ///< a sliding guide comes to rest
  slip,            ///< a guide at rest breaks away
  normal_reversal  ///< a contact force passes to the other face
};

constexpr const char* name(EventKind kind) noexcept {
  switch (kind) {
    case EventKind::slip_reversal:
      return "slip_reversal";
    case EventKind::stick:
      return "stick";
    case EventKind::slip:
      return "slip";
    case EventKind::normal_reversal:
      return "normal_reversal";
  }
  return "unknown";
}

struct Event {
  double t;  ///< s
  int guide;
  int contact;  ///< of the guide, 0 or 1; none for what the whole guide does
  EventKind kind;
};

/// The whole state of a mechanism: a copy of it replays bit for bit. Plain data.
template <class Size>
struct State {
  double start = 0;                                     ///< time of step 0, s
  double dt = 0;                                        ///< of the steps counted since `start`, s
  long long steps = 0;                                  ///< made since `start`
  double q[at_least_one(Size::coordinates)] = {};       ///< body by body; rad | m | m, m, rad
  double v[at_least_one(Size::coordinates)] = {};       ///< q', per second
  signed char mode[at_least_one(Size::guides)] = {};    ///< +1, -1: the slip direction; 0: at rest
  signed char sign[at_least_one(Size::contacts)] = {};  ///< of each contact force, guide by guide
  bool decided = false;  ///< mode and sign hold. False, as at the start and after q or v were set by hand: the next
                         ///< step finds them, and takes a guide to be at rest if its sliding speed is zero to rounding

  /// start + steps dt: a product, because a sum of a million steps would drift by 1e-6 s.
  constexpr double time() const noexcept { return start + static_cast<double>(steps) * dt; }
};

template <class Size>
constexpr bool operator==(const State<Size>& a, const State<Size>& b) noexcept {
  bool same = a.start == b.start && a.dt == b.dt && a.steps == b.steps && a.decided == b.decided;
  for (int j = 0; j < Size::coordinates; ++j) same = same && a.q[j] == b.q[j] && a.v[j] == b.v[j];
  for (int g = 0; g < Size::guides; ++g) same = same && a.mode[g] == b.mode[g];
  for (int c = 0; c < Size::contacts; ++c) same = same && a.sign[c] == b.sign[c];
  return same;
}

template <class Size>
constexpr bool operator!=(const State<Size>& a, const State<Size>& b) noexcept {
  return !(a == b);
}

/// A live value, its rate and its acceleration at the start of a step; within the step it is
/// value + rate tau + acceleration tau^2 / 2. A drive with law = "input" follows it, a load is scaled by it.
struct Input {
  double value = 0, rate = 0, acceleration = 0;
};

template <class Size>
struct Inputs {
  Input input[at_least_one(Size::inputs)];
};

/// Energy that crossed the mechanism's border, J, or its rate, W:
/// final - initial = work - dissipated + constraint_work.
struct EnergyFlow {
  double work = 0;             ///< by drives and loads
  double dissipated = 0;       ///< by friction on the slip of its guide and by dampers: never negative at an instant
  double constraint_work = 0;  ///< by constraint forces and friction on the drift: sum of lambda Phi' and the like
};

/// Forces at one instant, with the slip directions and contact signs that hold just after it. Plain data, filled in by
/// whoever makes it: valid only beside a report that says ok.
template <class Size>
struct Reaction {
  double t;
  double lambda[at_least_one(Size::contacts)];           ///< on the slider along n, N; guide by guide
  double friction[at_least_one(Size::guides)];           ///< on the slider along `tangent`, N
  double slip[at_least_one(Size::guides)];               ///< sliding speed of the slider along `tangent`, m/s
  double drive[at_least_one(Size::drives)];              ///< on the driven coordinate, N m | N
  Vec2 pin[at_least_one(Size::pins)];                    ///< on body a, world's frame, N
  double acceleration[at_least_one(Size::coordinates)];  ///< q''
  EnergyFlow power;                                      ///< W
  double drift_position;                                 ///< max |Phi|, |phi|
  double drift_velocity;                                 ///< max |Phi'|, |phi'|
};

/// What a step (or a reaction) says of itself.
struct Report {
  static constexpr int room = 32;  ///< for events: the most that one step may span

  Status status = Status::ok;
  Uniqueness uniqueness = Uniqueness::certified;  ///< the weakest over all decisions of the step
  int evaluations = 0;                            ///< of accelerations and forces
  int solves = 0;                                 ///< linear solves of the hardest HLCP
  double residual = 0;        ///< largest self-check residual, in units of its rounding scale: see acceleration.hpp
  double drift_position = 0;  ///< max |Phi|, |phi| where the step starts, m | rad
  double drift_velocity = 0;  ///< max |Phi'|, |phi'| there
  int events = 0;             ///< located, in the order of time
  Event event[room];          ///< the first `events` are valid
  int unlocated_events = 0;   ///< changes of mode or contact sign that the step went over; by euler, which looks at a
                              ///< step's start alone, that the step before went over. One more where the step turns a
                              ///< coordinate by more than `far_turn`, so that others may have gone unseen
  int guide = none;           ///< the guide that a refusal, or `refuted`, is about
  EnergyFlow energy;          ///< J, of this step
};

}  // namespace slideway
