// What the tests of the oracle share: scenes as multiprecision models, and agreement counted in decimal digits.
#pragma once

#include <gtest/gtest.h>

#include <boost/math/constants/constants.hpp>
#include <slideway/io/scene_file.hpp>
#include <slideway/oracle/friction.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace slideway::test {

using oracle::Real;
using RealModel = oracle::Model<Real>;
using RealVec = oracle::Vec<Real>;

inline const Real pi = boost::math::constants::pi<Real>();

/// a / b, where neither is a double.
inline Real ratio(int a, int b) { return Real(a) / b; }

/// The model of a scene file, PATH=VALUE settings applied; the path is relative to the source tree.
inline RealModel model_of_file(const std::string& path, const std::vector<std::string>& settings = {}) {
  const io::Reading reading = io::read_scene(SLIDEWAY_SOURCE_DIR "/" + path, settings);
  if (!reading.scene) throw std::runtime_error(to_string(reading.defects.front()));
  return oracle::model_of<Real>(reading.scene->scene);
}

inline RealModel shipped(const std::string& name, const std::vector<std::string>& settings = {}) {
  return model_of_file("scenes/" + name + ".toml", settings);
}

inline RealModel of_these_tests(const std::string& name, const std::vector<std::string>& settings = {}) {
  return model_of_file("tests/data/scenes/" + name + ".toml", settings);
}

/// How many decimal digits all compared pairs share: -log10 of the largest |got - expected| / scale; 50 at most.
class Agreement {
 public:
  void compare(const Real& got, const Real& expected, const Real& scale) {
    const Real miss = abs(Real(got - expected));
    if (!(miss == 0)) digits_ = std::min(digits_, (miss >= 0 ? Real(-log10(Real(miss / scale))) : Real(-1)));
  }
  void compare(const Real& got, const Real& expected) { compare(got, expected, Real(abs(expected))); }
  /// Components relative to the largest.
  void compare_all(const std::vector<Real>& got, const std::vector<Real>& expected) {
    ASSERT_EQ(got.size(), expected.size());
    Real scale(0);
    for (const Real& x : expected) scale = std::max(scale, Real(abs(x)));
    for (std::size_t i = 0; i < got.size(); ++i) compare(got[i], expected[i], scale);
  }
  /// Records the figure under a name and holds it to `bar` digits.
  void hold(const std::string& what, double bar) const {
    const double figure = static_cast<double>(digits_);
    ::testing::Test::RecordProperty(what + "_digits", std::to_string(figure));
    EXPECT_GE(figure, bar) << what;
  }

 private:
  Real digits_{50};
};

/// A body that only what is added holds.
inline RealModel::Body free_body(const Real& mass, const Real& inertia, const RealVec& com = {Real(0), Real(0)}) {
  return {ground, Joint::planar, {Real(0), Real(0)}, {Real(1), Real(0)}, Real(0), mass, com, inertia};
}

/// A guide on the ground through the origin, `slope` its angle against x.
inline RealModel::Guide ground_guide(int slider, const Real& slope, const std::vector<RealVec>& contacts,
                                     const Real& mu, const Real& mu_static) {
  return {slider,  ground, {Real(0), Real(0)}, {Real(cos(slope)), Real(sin(slope))}, contacts, mu, mu_static,
          Real(0), Real(0)};
}

/// A model, its dynamics and Coulomb's law at the model's start.
struct AtStart {
  explicit AtStart(const RealModel& model)
      : dynamics(model, oracle::FrictionLaw<Real>::orders + 1),
        law(dynamics),
        motion(dynamics.place(Real(0), model.start.q, model.start.v)) {
    dynamics.begin(motion);
  }
  std::vector<oracle::Solution<Real>> solutions(const std::vector<bool>& at_rest) {
    oracle::Coefficients<Real> mu;
    for (const auto& guide : dynamics.mechanism.model.guide) mu.push_back(guide.mu);
    return law.solutions(motion, at_rest, mu);
  }
  oracle::Decision<Real> decide() { return law.decide(motion, law.find_at_rest(motion, Real(1e-12))); }

  oracle::Dynamics<Real> dynamics;
  oracle::FrictionLaw<Real> law;
  oracle::Motion<Real> motion;
};

}  // namespace slideway::test
