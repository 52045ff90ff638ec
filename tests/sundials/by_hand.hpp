// Mechanisms of one degree of freedom as a textbook has them: Newton's and Euler's equations of each body in one mode,
// written for the mechanism, with numbers as in its scene file. Nothing here is computed by kernel or oracle.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "solvers.hpp"

namespace slideway::test {

constexpr double gravity = 9.81;  // m/s^2, downwards

/// y = (s, s'), s the coordinate that the equations are written in. Static and kinetic friction are the same.
class ByHand : public OdeMotion {
 public:
  void rates(double, const double* at, double* dy) override {
    dy[0] = at[1];
    dy[1] = solve(at[0], at[1]).acceleration;
  }
  int conditions() const override { return static_cast<int>(sign.size() + slip.size()); }
  void margins(double, const double* at, double* margin) override {
    const Answer now = solve(at[0], at[1]);
    for (std::size_t c = 0; c < sign.size(); ++c) *margin++ = sign[c] * now.lambda[c];
    for (std::size_t g = 0; g < slip.size(); ++g) *margin++ = slip[g] * now.speed[g];
  }
  void change_mode(const std::vector<int>& failed) override {
    const std::vector<int> sign_before = sign, slip_before = slip;
    for (int i : failed) {
      const auto k = static_cast<std::size_t>(i);
      if (k < sign.size()) {
        sign[k] = -sign[k];
      } else {
        leave_zero_speed(k - sign.size());
      }
    }
    note("guide ", "slip_reversal", slip_before, slip);
    note("contact ", "normal_reversal", sign_before, sign);
  }

 protected:
  struct Answer {
    double acceleration;  ///< s''
    Vector lambda;        ///< of each contact
    Vector speed, rate;   ///< of each guide: sliding speed and its rate
  };
  virtual Answer solve(double s, double ds) const = 0;

  /// The mode is given by speeds; then signs are those of the forces that they give.
  void start(double s, double ds, const std::vector<int>& slips, std::size_t contacts) {
    y = {s, ds};
    unit = {std::fmax(1, std::fabs(s)), std::fabs(ds)};
    slip = slips;
    sign.assign(contacts, 1);
    if (!find_signs()) throw std::runtime_error("no contact forces at the start");
  }

  std::vector<int> slip, sign;  ///< of each guide, of each contact

 private:
  bool find_signs() {
    for (unsigned pattern = 0; pattern < 1u << sign.size(); ++pattern) {
      for (std::size_t c = 0; c < sign.size(); ++c) sign[c] = (pattern >> c & 1) != 0 ? -1 : 1;
      const Answer now = solve(y[0], y[1]);
      bool fits = true;
      for (std::size_t c = 0; c < sign.size(); ++c) fits = fits && sign[c] * now.lambda[c] >= 0;
      if (fits) return true;
    }
    return false;
  }
  void leave_zero_speed(std::size_t g) {
    for (const int direction : {-slip[g], slip[g]}) {
      slip[g] = direction;
      if (find_signs() && direction * solve(y[0], y[1]).rate[g] > 0) return;
    }
    throw std::runtime_error("a guide stays at rest, which these mechanisms do not");
  }
  void note(const char* where, const char* kind, const std::vector<int>& before, const std::vector<int>& after) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (before[i] != after[i]) events.push_back({t, where + std::to_string(i), kind});
    }
  }
};

/// scenes/crank_rocker_free.toml. s: the crank's angle phi from +x.
class CrankRocker final : public ByHand {
 public:
  CrankRocker() { start(0, 3, {1}, 2); }

  Vector joints() override {
    const Pose p(y[0], y[1]);
    return {p.theta, y[0], p.theta - y[0], p.dtheta, y[1], p.dtheta - y[1]};
  }

 private:
  static constexpr double mu = 0.2, a = 0.05;                                      // contacts at -a and a on the block
  static constexpr double m1 = 4, l1 = 1, j1 = 1.3333333333333333 + m1 * l1 * l1;  // rocker, about O1
  static constexpr double m2 = 2, l2 = 0.25, j2 = 0.041666666666666667 + m2 * l2 * l2;  // crank, about O2
  static constexpr double m3 = 0.5, l = 0.5, j3 = 1e-3;                                 // block, at the crank's tip

  struct Pose {
    Pose(double phi, double dphi)
        : along_crank(std::cos(phi), std::sin(phi)), across_crank(-std::sin(phi), std::cos(phi)) {
      const Eigen::Vector2d tip = Eigen::Vector2d(0, 1) + l * along_crank, velocity = l * dphi * across_crank;
      r = tip.norm();
      along = tip / r;
      across = {-along.y(), along.x()};
      theta = std::atan2(along.y(), along.x());
      dtheta = across.dot(velocity) / r;
      dr = along.dot(velocity);
    }
    Eigen::Vector2d along_crank, across_crank, along, across;  ///< the crank; the slot
    double theta, dtheta, r, dr;                               ///< rocker's angle, tip's distance from O1
  };

  Answer solve(double phi, double dphi) const override {
    const Pose p(phi, dphi);
    const double push = l * p.across_crank.dot(p.across), drag = l * p.across_crank.dot(p.along) * mu * slip[0];
    Eigen::Matrix4d lhs;  // unknowns: phi'', theta'', lambda of both contacts
    Eigen::Vector4d rhs;
    lhs << -push, p.r, 0, 0,                                                 // the tip's acceleration across the slot
        0, j1, p.r - a, p.r + a,                                             // rocker about O1
        0, j3, a, -a,                                                        // block about the tip
        j2 + m3 * l * l, 0, -push + drag * sign[0], -push + drag * sign[1];  // crank and block's mass about O2
    rhs << -2 * p.dr * p.dtheta - l * dphi * dphi * p.along_crank.dot(p.across), -m1 * gravity * l1 * p.along.x(), 0,
        -(m2 * l2 + m3 * l) * gravity * p.along_crank.x();
    const Eigen::Vector4d x = lhs.partialPivLu().solve(rhs);
    const Eigen::Vector2d acceleration = l * (x(0) * p.across_crank - dphi * dphi * p.along_crank);
    return {x(0), {x(2), x(3)}, {p.dr}, {p.along.dot(acceleration) + p.r * p.dtheta * p.dtheta}};
  }
};

/// scenes/elliptic_trammel.toml. s: the rod's angle th; ends A = (-2 cos th, 0), B = (0, 2 sin th), half length 1.
class Trammel final : public ByHand {
 public:
  Trammel() { start(0.52359877559829887, 6, {1, 1}, 2); }

  Vector joints() override {
    const double c = std::cos(y[0]), s = std::sin(y[0]);
    return {-c, s, y[0], s * y[1], c * y[1], y[1]};
  }

 private:
  static constexpr double mu = 0.2, m = 1, inertia = 0.33333333333333333;

  Answer solve(double th, double dth) const override {
    const double c = std::cos(th), s = std::sin(th), w = dth * dth;
    const double fa = -mu * slip[0] * sign[0], fb = -mu * slip[1] * sign[1];  // friction over contact force
    Eigen::Matrix3d lhs;                   // unknowns: th'', contact forces upwards at A, to the left at B
    lhs << m * s, -fa, 1,                  // middle to the right: m (s th'' + c th'^2)
        m * c, -1, -fb,                    // middle upwards: m (c th'' - s th'^2)
        inertia, c - fa * s, -s - fb * c;  // about the middle: A at (-c, -s), B at (c, s) from it
    const Eigen::Vector3d x = lhs.partialPivLu().solve(Eigen::Vector3d(-m * c * w, m * s * w - m * gravity, 0));
    return {x(0), {x(1), x(2)}, {2 * s * dth, 2 * c * dth}, {2 * (s * x(0) + c * w), 2 * (c * x(0) - s * w)}};
  }
};

/// scenes/slider_crank.toml with mu = 0.2. s: the crank's angle phi; the rod at psi < 0 from the tip to the slider.
class SliderCrank final : public ByHand {
 public:
  SliderCrank() { start(0.001, 150, {-1}, 2); }

  Vector joints() override {
    const Pose p(y[0], y[1]);
    return {y[0], p.psi - y[0], -p.psi, y[1], p.dpsi - y[1], -p.dpsi};
  }

 private:
  static constexpr double mu = 0.2, l = 0.153, m = 0.038, i = 7.4e-5 + m * l * l / 4;  // crank, about its bearing
  static constexpr double lr = 0.306, mr = 0.038, ir = 5.9e-4, ms = 0.076;             // rod, slider

  struct Pose {
    Pose(double phi, double dphi) : c(l * std::cos(phi)), s(l * std::sin(phi)), psi(-std::asin(s / lr)) {
      dpsi = -c * dphi / (lr * std::cos(psi));
    }
    double c, s, psi, dpsi;  ///< (c, s): the tip
  };

  Answer solve(double phi, double dphi) const override {
    const Pose p(phi, dphi);
    const double hc = lr / 2 * std::cos(p.psi), hs = lr / 2 * std::sin(p.psi);  // from the rod's end to its middle
    const double w = dphi * dphi, wr = p.dpsi * p.dpsi, friction = -mu * slip[0] * sign[0];
    // Unknowns: phi'', psi'', x'' of the slider; force of crank on rod (x, y), of slider on rod (x, y); of way on
    // slider
    Eigen::Matrix<double, 8, 8> lhs;
    Eigen::Matrix<double, 8, 1> rhs;
    lhs << p.c, 2 * hc, 0, 0, 0, 0, 0, 0,         // the slider does not rise
        p.s, 2 * hs, 1, 0, 0, 0, 0, 0,            // and moves with the rod's end
        i, 0, 0, -p.s, p.c, 0, 0, 0,              // crank about its bearing
        -mr * p.s, -mr * hs, 0, -1, 0, -1, 0, 0,  // rod's middle along x
        mr * p.c, mr * hc, 0, 0, -1, 0, -1, 0,    // and y
        0, ir, 0, -hs, hc, hs, -hc, 0,            // rod about its middle
        0, 0, ms, 0, 0, 1, 0, -friction,          // slider along x
        0, 0, 0, 0, 0, 0, 1, -1;                  // and y
    rhs << p.s * w + 2 * hs * wr, -p.c * w - 2 * hc * wr, -m * gravity * p.c / 2, mr * (p.c * w + hc * wr),
        mr * (p.s * w + hs * wr - gravity), 0, 0, -ms * gravity;
    const Eigen::Matrix<double, 8, 1> x = lhs.partialPivLu().solve(rhs);
    // The slider does not turn, and friction acts through its pin: both contacts carry the same.
    return {x(0), {x(7) / 2, x(7) / 2}, {-p.s * dphi - 2 * hs * p.dpsi}, {x(2)}};
  }
};

/// A block on a belt that moves at 0.1 m/s, held by a spring to the ground: y = (x, x').
class BlockOnBelt final : public OdeMotion {
 public:
  BlockOnBelt() {
    y = {0.3, belt};  // on the belt
    unit = {1, belt};
  }
  void rates(double, const double* at, double* dy) override {
    dy[0] = at[1];
    dy[1] = held ? 0 : (mu * m * gravity - k * at[0]) / m;  // the belt is faster than the block, and drags it on
  }
  int conditions() const override { return 1; }
  void margins(double, const double* at, double* margin) override {
    *margin = held ? mu_static * m * gravity - k * at[0] : belt - at[1];
  }
  void change_mode(const std::vector<int>&) override {
    held = !held;
    y[1] = belt;
    events.push_back({t, "guide 0", held ? "stick" : "slip"});
  }
  Vector joints() override { return {belt * t, y[0], 0, 0, belt, y[1], 0, 0}; }

 private:
  static constexpr double m = 1, k = 2, mu_static = 0.15, mu = 0.1, belt = 0.1;
  bool held = true;
};

}  // namespace slideway::test
