// The modes of any scene on its way through SUNDIALS: which quantities end a mode, and which mode follows. Contact
// forces that vanish and friction limits that are reached say so themselves; where a guide comes to rest the oracle's
// law decides, in its own digits.
#pragma once

#include <slideway/oracle/friction.hpp>

#include "solvers.hpp"

namespace slideway::test {

/// y = (positions, speeds), and for IDA (accelerations, forces of constraints, friction of guides at rest).
template <class Base>
class Modes : public Base {
 public:
  Modes(const oracle::Model<oracle::Real>& exact, const oracle::Model<double>& model)
      : exact_(exact, oracle::FrictionLaw<oracle::Real>::orders + 1),
        exact_law_(exact_),
        dynamics_(model, 3),
        law_(dynamics_) {
    const auto motion = exact_.place(oracle::Real(0), exact.start.q, exact.start.v);
    const auto at_rest = exact_law_.find_at_rest(motion, oracle::Real(0x1p-40));
    this->unit.assign(2 * size(), 1);
    decide(motion, at_rest);
    double fastest = 0;
    for (std::size_t i = size(); i < 2 * size(); ++i) fastest = std::max(fastest, std::abs(this->y[i]));
    std::fill_n(this->unit.rbegin(), size(), fastest);
  }

  int conditions() const override { return static_cast<int>(conditions_.size()); }

  void change_mode(const std::vector<int>& failed) override {
    const oracle::Mode before = shown_mode();
    bool reaches_rest = false;
    std::vector<bool> at_rest = at_rest_;
    for (int i : failed) {
      const auto [kind, index, side] = conditions_[static_cast<std::size_t>(i)];
      const auto k = static_cast<std::size_t>(index);
      if (kind == oracle::Condition::face) mode_.sign[k] = -side;
      if (kind == oracle::Condition::slip) reaches_rest = at_rest[k] = true;
      if (kind == oracle::Condition::hold) leave_rest(k, -side);
    }
    if (reaches_rest) {
      decide(exact_motion(), at_rest);
    } else {
      begin_mode();
      turn_other_faces(failed);
    }
    note(before, shown_mode());
  }

  Vector joints() override {
    begin(this->t, this->y.data());
    Vector q, v;
    for (const auto& row : dynamics_.mechanism.coordinate) {
      q.push_back(row.value[0]);
      v.push_back(row.speed[0]);
    }
    q.insert(q.end(), v.begin(), v.end());
    return q;
  }

 protected:
  using Row = typename oracle::Mechanism<double>::Row;

  std::size_t size() const { return 3 * static_cast<std::size_t>(dynamics_.mechanism.bodies()); }
  void begin(double at, const double* now) {
    dynamics_.begin({at, Vector(now, now + size()), Vector(now + size(), now + 2 * size())});
  }
  void solve(double at, const double* now) {
    begin(at, now);
    if (!dynamics_.solve(mode_, mu_)) throw std::runtime_error("the KKT matrix is singular");
  }

  oracle::Dynamics<oracle::Real> exact_;
  oracle::FrictionLaw<oracle::Real> exact_law_;
  oracle::Dynamics<double> dynamics_;
  oracle::FrictionLaw<double> law_;
  oracle::Mode mode_;
  std::vector<bool> at_rest_;
  Vector mu_;
  std::vector<oracle::Condition> conditions_;

 private:
  oracle::Motion<oracle::Real> exact_motion() const {
    const auto middle = this->y.begin() + static_cast<std::ptrdiff_t>(size());
    return {oracle::Real(this->t), {this->y.begin(), middle}, {middle, middle + static_cast<std::ptrdiff_t>(size())}};
  }

  /// What Coulomb's law says at a motion, moved onto the constraints, and guides that stay at rest to speed zero: those
  /// that pass through it may do so by geometry, at a dead centre, where any other speed is far away.
  void decide(oracle::Motion<oracle::Real> motion, const std::vector<bool>& at_rest) {
    const std::vector<bool> none_at_rest(at_rest.size(), false);
    if (!exact_.project(motion, none_at_rest)) throw std::runtime_error("off the constraints");
    const auto decision = exact_law_.decide(motion, at_rest);
    if (decision.verdict == oracle::Verdict::none || decision.verdict == oracle::Verdict::several) {
      throw std::runtime_error("Coulomb's law does not allow one motion alone");
    }
    mode_ = decision.solutions.front().mode;
    at_rest_ = decision.solutions.front().at_rest;
    if (!exact_.project(motion, at_rest_)) throw std::runtime_error("off the constraints");
    mu_.clear();
    for (const auto& mu : decision.mu) mu_.push_back(static_cast<double>(mu));
    this->y.clear();
    for (const auto& x : motion.position) this->y.push_back(static_cast<double>(x));
    for (const auto& v : motion.velocity) this->y.push_back(static_cast<double>(v));
    begin_mode();
  }

  void begin_mode() {
    conditions_ = law_.conditions(mode_, at_rest_, mu_, true);
    std::erase_if(conditions_, [&](const oracle::Condition& c) {
      return c.kind == oracle::Condition::slip && at_rest_[static_cast<std::size_t>(c.index)];
    });
  }

  /// At its limit a guide yields to the push.
  void leave_rest(std::size_t guide, int direction) {
    at_rest_[guide] = false;
    mode_.slip[guide] = direction;
    mu_[guide] = dynamics_.guide(static_cast<int>(guide)).mu;
  }

  /// A face that was left may take others with it: two contacts that carry the same.
  void turn_other_faces(const std::vector<int>& turned) {
    std::vector<bool> done(conditions_.size());
    for (int i : turned) done[static_cast<std::size_t>(i)] = true;
    for (bool again = true; again;) {
      again = false;
      solve(this->t, this->y.data());
      for (std::size_t i = 0; i < conditions_.size() && !again; ++i) {
        if (done[i] || conditions_[i].kind != oracle::Condition::face || law_.value(conditions_[i], 0) > 0) continue;
        mode_.sign[static_cast<std::size_t>(conditions_[i].index)] *= -1;
        done[i] = again = true;
        begin_mode();
      }
    }
  }

  oracle::Mode shown_mode() const {
    oracle::Mode shown = mode_;
    for (std::size_t g = 0; g < at_rest_.size(); ++g) shown.slip[g] = at_rest_[g] ? 0 : mode_.slip[g];
    return shown;
  }

  void note(const oracle::Mode& before, const oracle::Mode& after) {
    for (std::size_t g = 0; g < before.slip.size(); ++g) {
      const int was = before.slip[g], is = after.slip[g];
      const char* kind = is == 0 ? "stick" : was == 0 ? "slip" : "slip_reversal";
      if (was != is) this->events.push_back({this->t, "guide " + std::to_string(g), kind});
    }
    for (std::size_t c = 0; c < before.sign.size(); ++c) {
      if (before.sign[c] == after.sign[c]) continue;
      this->events.push_back({this->t, "contact " + std::to_string(c), "normal_reversal"});
    }
  }
};

}  // namespace slideway::test
