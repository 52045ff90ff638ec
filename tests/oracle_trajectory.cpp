// The oracle's trajectories: closed forms of what sticks, slips and stops; runs of different order and step against
// each other; published values.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <slideway/oracle/trajectory.hpp>
#include <stdexcept>
#include <support/oracle.hpp>

namespace {

using slideway::EventKind;
using namespace slideway::oracle;
using namespace slideway::test;
using slideway::ground;
using slideway::Joint;
using slideway::Law;

/// Runs to the last of the times. No run of these tests needs many steps: one that does not advance fails, not hangs.
Trajectory<Real> run(const RealModel& model, const std::vector<Real>& times, TrajectoryOptions options = {}) {
  options.progress = [steps = 0](double t) mutable {
    if (++steps > 1000) throw std::runtime_error("no progress at t = " + std::to_string(t));
  };
  auto trajectory = Integrator<Real>(model, options).run(times.back(), times);
  EXPECT_EQ(trajectory.end, End::duration);
  EXPECT_EQ(trajectory.t, times.back());
  if (trajectory.samples.size() != times.size()) throw std::runtime_error("ended at t = " + trajectory.t.str(10));
  EXPECT_LT(trajectory.energy_miss, Real("1e-28"));
  EXPECT_FALSE(trajectory.unverified);
  ::testing::Test::RecordProperty("energy_miss", trajectory.energy_miss.str(3));
  return trajectory;
}

void expect_events(const Trajectory<Real>& trajectory, const std::vector<EventKind>& kinds) {
  std::vector<EventKind> found;
  for (const auto& event : trajectory.events) found.push_back(event.kind);
  EXPECT_EQ(found, kinds);
}

// ---- A block on a plane

/// The scene's block with decimal data: 1 kg, 9.81 m/s^2.
RealModel block(const Real& mu, const Real& speed, const Real& push) {
  RealModel m = shipped("block_on_plane");
  m.gravity.y = Real("-9.81");
  m.start.v[0] = speed;
  m.guide[0].mu = m.guide[0].mu_static = mu;
  m.load = {{0, m.body[0].com, {push, 0}, 0}};
  return m;
}

TEST(BlockOnPlane, StopsAndStays) {  // after v / (mu g), v^2 / (2 mu g) away
  const auto trajectory = run(block(ratio(1, 5), 1, 0), {ratio(1, 4), 1, 10});
  expect_events(trajectory, {EventKind::stick});
  ASSERT_FALSE(trajectory.events.empty());
  const Real rate("1.962");
  Agreement stop, printed;
  stop.compare(trajectory.events[0].t, 1 / rate);
  stop.compare(trajectory.samples[0].q[0], Real(ratio(1, 4) - rate / 32));
  for (const std::size_t k : {1, 2}) {
    stop.compare(trajectory.samples[k].q[0], Real(1 / (2 * rate)));
    stop.compare(trajectory.samples[k].dissipated, ratio(1, 2));
    EXPECT_EQ(trajectory.samples[k].mode.slip[0], 0);
  }
  stop.hold("stop", 40);
  printed.compare(trajectory.events[0].t, Real("0.50968399592252803262"));
  printed.compare(trajectory.samples[2].q[0], Real("0.25484199796126401631"));
  printed.hold("printed", 19.5);
}

TEST(BlockOnPlane, DoesNotMoveUnderHalfOfWhatFrictionCanHold) {
  RealModel m = block(1, 0, 5);
  m.gravity.y = -10;
  const auto trajectory = run(m, {1, 10});
  expect_events(trajectory, {});
  for (const auto& now : trajectory.samples) {
    EXPECT_LT(abs(now.q[0]), Real("1e-40"));
    EXPECT_LT(abs(now.v[0]), Real("1e-40"));
    EXPECT_LT(abs(Real(now.friction[0] + 5)), Real("1e-40"));
    EXPECT_EQ(now.mode.slip[0], 0);
  }
}

/// m v' = -mu m g - c v: v = (v0 + s) e^(-c t) - s with s = mu g / c, and it stops when that is 0.
TEST(BlockOnPlane, ViscousFrictionSlowsItExponentially) {
  const Real c = ratio(3, 2), v0 = 2;
  Agreement all;
  for (const Real& mu : {Real(0), ratio(1, 5)}) {
    RealModel m = block(mu, v0, 0);
    m.guide[0].viscous = c;
    const Real s = mu * Real("9.81") / c, t = ratio(1, 2), decay = exp(Real(-c * t));
    const auto trajectory = run(m, {t, 3});
    const Instant<Real>& now = trajectory.samples[0];
    all.compare(now.v[0], Real((v0 + s) * decay - s));
    all.compare(now.q[0], Real((v0 + s) * (1 - decay) / c - s * t));
    all.compare(now.friction[0], Real(-mu * Real("9.81") - c * now.v[0]));
    all.compare(now.dissipated, Real((v0 * v0 - now.v[0] * now.v[0]) / 2));
    expect_events(trajectory, mu > 0 ? std::vector{EventKind::stick} : std::vector<EventKind>{});
    if (mu > 0 && !trajectory.events.empty()) all.compare(trajectory.events[0].t, Real(log(Real(1 + v0 / s)) / c));
  }
  all.hold("viscous", 33);  // truncation 1e-36 a step
}

/// Friction mu N + preload.
TEST(BlockOnPlane, PreloadHoldsItAndBrakesIt) {
  const auto with = [](const Real& speed, const Real& push) {
    RealModel m = block(ratio(1, 10), speed, push);
    m.guide[0].preload = ratio(69, 10);  // with mu N = 0.981: 7.881 N
    return m;
  };
  const Real bound("7.881");
  const auto held = run(with(0, bound - ratio(1, 1000)), {2});
  expect_events(held, {});
  EXPECT_LT(abs(held.samples[0].q[0]), Real("1e-40"));
  const auto pushed = run(with(0, bound + ratio(1, 1000)), {2});
  const auto braked = run(with(1, 0), {2});
  expect_events(braked, {EventKind::stick});
  Agreement all;
  all.compare(pushed.samples[0].q[0], ratio(2, 1000));
  all.compare(pushed.samples[0].friction[0], -bound);
  all.compare(braked.samples[0].q[0], 1 / (2 * bound));
  all.compare(braked.samples[0].dissipated, ratio(1, 2));
  RealModel smooth = with(1, 0);  // no Coulomb friction, only preload
  smooth.guide[0].mu = smooth.guide[0].mu_static = 0;
  all.compare(run(smooth, {2}).samples[0].q[0], 1 / (2 * ratio(69, 10)));
  all.hold("preload", 40);
}

TEST(BlockOnPlane, FollowsItsDriveWhateverTheLaw) {  // slowly enough for both feet to carry: |x''| < g
  const struct {
    Law law;
    std::vector<Real> c;
    std::function<std::array<Real, 3>(const Real&)> truth;
  } cases[] = {
      {Law::uniform,
       {1, 2},
       [](const Real& t) {
         return std::array<Real, 3>{1 + 2 * t, Real(2), Real(0)};
       }},
      {Law::polynomial,
       {1, -2, ratio(3, 10), ratio(-4, 10)},
       [](const Real& t) {
         return std::array<Real, 3>{1 + t * (-2 + t * (3 - 4 * t) / 10), -2 + t * (6 - 12 * t) / 10, (6 - 24 * t) / 10};
       }},
      {Law::harmonic, {1, ratio(1, 5), 3, ratio(1, 2)}, [](const Real& t) {
         const Real phase = 3 * t + ratio(1, 2);
         return std::array<Real, 3>{1 + sin(phase) / 5, 3 * cos(phase) / 5, -9 * sin(phase) / 5};
       }}};
  const Real t = ratio(17, 10), mu = ratio(1, 5);
  Agreement all;
  for (const auto& one : cases) {
    RealModel m = block(mu, 0, 0);
    m.drive = {{0, 0, one.law, one.c}};
    const auto start = one.truth(0), end = one.truth(t);
    m.start.q[0] = start[0];
    m.start.v[0] = start[1];
    const auto now = run(m, {t}).samples[0];
    all.compare_all({now.q[0], now.v[0], now.acceleration[0]}, {end[0], end[1], end[2]});
    all.compare(now.drive[0], Real(end[2] + mu * Real("9.81") * (end[1] > 0 ? 1 : -1)));
  }
  all.hold("laws", 33);
}

// ---- Stick and slip

/// Slip: x'' = mu g - 2 x from x = mu0 g / 2 at the belt's speed until that speed comes back; x = centre + amplitude
/// cos(w t - swing). Stick: back to where it left.
TEST(Belt, SticksAndSlipsInClosedForm) {
  RealModel m = shipped("belt");
  const Real g("9.81"), speed = ratio(1, 10), mu = ratio(1, 10), mu_static = ratio(3, 20), w = sqrt(Real(2));
  m.gravity.y = -g;
  m.guide[0].mu = mu;
  m.guide[0].mu_static = mu_static;
  m.drive[0].c = {0, speed};
  m.start.v = {speed, speed, 0, 0};
  const Real centre = mu * g / 2, reach = (mu_static - mu) * g / 2, swing = atan2(Real(speed / w), reach);
  const Real amplitude = sqrt(Real(reach * reach + speed * speed / 2));
  const Real stick = 2 * reach / speed, slip = (pi + 2 * swing) / w, leave = mu_static * g / 2 / speed;
  const Real top = leave + slip + stick + swing / w;  // of the second slip
  const auto trajectory = run(m, {1, top, top + pi / w, 30});
  using Kind = EventKind;
  expect_events(trajectory, {Kind::slip, Kind::stick, Kind::slip, Kind::stick, Kind::slip, Kind::stick, Kind::slip});
  Agreement events, places, printed;
  Real t = leave;
  for (std::size_t k = 0; k < trajectory.events.size(); ++k) {
    events.compare(trajectory.events[k].t, t);
    t += k % 2 == 0 ? slip : stick;
  }
  events.hold("events", 33);
  const auto& samples = trajectory.samples;
  places.compare(samples[0].q[1], speed);
  places.compare(samples[0].drive[0], Real(2 * speed));
  places.compare(samples[1].q[1], Real(centre + amplitude));
  places.compare(samples[2].q[1], Real(centre - amplitude));
  places.hold("places", 33);
  ASSERT_GE(trajectory.events.size(), 3u);
  printed.compare(Real(trajectory.events[1].t - trajectory.events[0].t), Real("2.6184222465698971961"));
  printed.compare(Real(trajectory.events[2].t - trajectory.events[1].t), Real("4.905"));
  printed.compare(samples[2].q[1], Real("0.23525979450721326455"));
  printed.compare(samples[1].q[1], Real("0.74574020549278673545"));
  printed.hold("printed", 19);
}

/// A start where the slip is zero to all digits, every term of it, and friction cannot hold it.
TEST(CrankRockerTrajectory, StartsAtAReversal) {
  for (const int quarter : {1, 3}) {
    RealModel m = shipped("crank_rocker");
    const Real crank = quarter * pi / 2;
    m.drive[0].c = {crank, Real(3)};
    m.start.q = {pi / 2, crank};
    m.start.v = {quarter == 1 ? Real(1) : Real(-3), 3};
    const auto trajectory = run(m, {Real("1e-3"), 1});
    EXPECT_EQ(trajectory.samples[0].mode.slip[0], quarter == 1 ? -1 : 1);
    Agreement all;  // r r' = 3/4 cos(3 t + crank), r^2 = 5/4 + sin(3 t + crank), for both times
    for (const auto& now : trajectory.samples) {
      const Real a = 3 * now.t + crank;
      all.compare(now.slip[0], Real(3 * cos(a) / (2 * sqrt(Real(ratio(5, 4) + sin(a))))));
    }
    all.hold("slip_" + std::to_string(quarter), 30);
  }
}

// ---- Runs of different order and step

void compare_runs(const RealModel& model, const Real& duration, const std::vector<EventKind>& among) {
  TrajectoryOptions fine;
  fine.digits = 42;
  fine.step = 0.8;
  const auto a = run(model, {duration / 3, duration}), b = run(model, {duration / 3, duration}, fine);
  Agreement ends, events;
  for (std::size_t k = 0; k < 2; ++k) {
    ends.compare_all(a.samples[k].q, b.samples[k].q);
    ends.compare_all(a.samples[k].v, b.samples[k].v);
    ends.compare_all(a.samples[k].lambda, b.samples[k].lambda);
  }
  ends.hold("end", 25);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) {
    EXPECT_EQ(a.events[k].kind, b.events[k].kind) << k;
    EXPECT_EQ(a.events[k].guide, b.events[k].guide) << k;
    EXPECT_EQ(a.events[k].contact, b.events[k].contact) << k;
    events.compare(a.events[k].t, b.events[k].t);
  }
  events.hold("event", 20);
  ::testing::Test::RecordProperty("events", static_cast<int>(a.events.size()));
  for (const EventKind kind : among) {
    EXPECT_TRUE(std::any_of(a.events.begin(), a.events.end(), [&](const auto& e) { return e.kind == kind; }))
        << name(kind);
  }
}

TEST(TwoRuns, OfASliderCrankAtSpeedAgree) {
  compare_runs(shipped("slider_crank", {"guide.way.mu=0.2"}), ratio(1, 10),
               {EventKind::slip_reversal, EventKind::normal_reversal});
}

TEST(TwoRuns, OfACrankRockerLeftToItselfAgree) {
  compare_runs(shipped("crank_rocker_free"), 1, {EventKind::slip_reversal, EventKind::normal_reversal});
}

TEST(TwoRuns, OfTheBeltAgree) { compare_runs(shipped("belt"), 30, {EventKind::stick, EventKind::slip}); }

TEST(TwoRuns, OfASliderCrankThatRestsAndBreaksAwayAgree) {
  compare_runs(of_these_tests("slider_crank_rests"), 6, {EventKind::stick, EventKind::slip, EventKind::slip_reversal});
}

// ---- Published values

TEST(Squeezer, MeetsItsPublishedAngles) {  // good to 1e-9 of the largest; the scene's own start is good to 1e-16
  const auto now = run(shipped("squeezer"), {ratio(3, 100)}).samples[0];
  // K1, K2, K3, K5, K4, K7, K6: beta, Theta, gamma, delta, Phi, eps, Omega
  const std::vector<Real> published = {Real("15.81077119"),  Real("-15.75637106"),  Real("0.0408222402"),
                                       Real("0.5244099659"), Real("-0.5347301163"), Real("1.0480807410"),
                                       Real("0.5347301163")};
  Agreement all;
  all.compare_all(now.q, published);
  all.hold("angles", 9);
}

}  // namespace
