#include <slideway/oracle/drift.hpp>

namespace slideway::oracle {

namespace {

template <class T>
Drift<T> larger(const Drift<T>& a, const Drift<T>& b) {
  return {std::max(a.position, b.position), std::max(a.velocity, b.velocity)};
}

/// M e, for magnitudes.
template <class T>
Drift<T> times(const Map<T>& M, const Drift<T>& e) {
  return {T(M(0, 0) * e.position + M(0, 1) * e.velocity), T(M(1, 0) * e.position + M(1, 1) * e.velocity)};
}

template <class T>
T size(const Vec<T>& r) {
  using std::abs;
  return abs(r.x) + abs(r.y);
}

/// Largest |Phi| and |Phi'| of constraints in Method::drift's order, a pin's two rows as one vector: its length does
/// not depend on the axes.
template <class T>
Drift<T> largest(const Model<T>& model, const std::vector<Drift<T>>& all) {
  using std::abs, std::sqrt;
  Drift<T> most{T(0), T(0)};
  const std::size_t first = model.drive.size(), end = first + 2 * model.pin.size();
  for (std::size_t i = 0; i < all.size(); ++i) {
    Drift<T> e = all[i];
    if (i >= first && i < end) {
      const Drift<T>& other = all[++i];
      e = {T(sqrt(e.position * e.position + other.position * other.position)),
           T(sqrt(e.velocity * e.velocity + other.velocity * other.velocity))};
    }
    most = larger(most, {T(abs(e.position)), T(abs(e.velocity))});
  }
  return most;
}

/// The longest arm in any body's frame or the ground's.
template <class T>
T longest_arm(const Model<T>& model) {
  T most(0);
  const auto raise = [&](const Vec<T>& r) { most = std::max(most, size(r)); };
  for (const auto& body : model.body) raise(body.at), raise(body.com);
  for (const auto& guide : model.guide) {
    raise(guide.origin);
    for (const auto& contact : guide.contact) raise(contact);
  }
  for (const auto& pin : model.pin) raise(pin.a_at), raise(pin.b_at);
  return most;
}

/// Largest distance of points from the origin and largest speeds of points and bodies, at most.
template <class T>
struct Extent {
  T reach, speed, turning;
};

template <class T>
Extent<T> extent(const Model<T>& model, const Motion<T>& motion) {
  using std::abs;
  Extent<T> most{T(0), T(0), T(0)};
  for (std::size_t i = 0; i < motion.position.size(); i += 3) {
    most.reach = std::max(most.reach, size(Vec<T>{motion.position[i], motion.position[i + 1]}));
    most.speed = std::max(most.speed, size(Vec<T>{motion.velocity[i], motion.velocity[i + 1]}));
    most.turning = std::max(most.turning, T(abs(motion.velocity[i + 2])));
  }
  const T arm = 2 * longest_arm(model);
  return {T(most.reach + arm), T(most.speed + most.turning * arm), most.turning};
}

/// What the forces on each body would give it one by one, all added up: they may cancel, their roundings do not. 0
/// where the law has no or several answers.
template <class T>
T accelerations_one_by_one(Method<T>& method, const TreeState<T>& at) {
  const Model<T>& model = method.dynamics().mechanism.model;
  const std::optional<std::vector<T>> load = method.loads(at);
  T sum(0);
  if (!load) return sum;
  const T lever = 2 * extent(model, method.dynamics().place(at.t, at.q, at.v)).reach;
  for (std::size_t i = 0; i < model.body.size(); ++i) {
    const auto& body = model.body[i];
    if (body.mass > 0) sum += ((*load)[3 * i] + (*load)[3 * i + 1]) / body.mass;
    if (body.inertia > 0) sum += lever * (*load)[3 * i + 2] / body.inertia;
  }
  return sum;
}

}  // namespace

template <class T>
Rounding<T> rounding(Method<T>& method, const TreeState<T>& from, const T& h, const TreeState<T>& to, const T& loads) {
  using std::abs;
  const T u(0x1p-53);
  const Model<T>& model = method.dynamics().mechanism.model;
  const Extent<T> most = extent(model, method.dynamics().place(from.t, from.q, from.v));
  const T items(8 * (static_cast<int>(model.body.size()) + 1));
  T places(0), speeds(0), accelerations(most.turning * most.turning * most.reach + loads);
  std::size_t j = 0;
  for (const auto& body : model.body) {
    const int count = coordinates(body.joint);
    for (int k = 0; k < count; ++k, ++j) {
      const bool turns = body.joint == Joint::revolute || k == 2;
      const T lever = turns ? T(2 * most.reach) : T(1), q = abs(from.q[j]), dv = abs(T(to.v[j] - from.v[j]));
      places += lever * q;
      speeds += lever * abs(from.v[j]) + q * (turns ? T(2 * most.speed) : most.turning);
      accelerations += lever * dv / h;
    }
  }
  const T place = items * most.reach, speed = items * most.speed;
  const T gained = h * (model.beta * place + model.alpha * speed + items * accelerations);
  return {{T(u * places), T(u * (speeds + gained))}, {T(u * (2 * places + place)), T(u * (2 * speeds + speed))}};
}

namespace {

/// Where the kernel's projection stops: of Phi, and of Phi' by roundings of the same number.
template <class T>
Drift<T> projection_limit(Method<T>& method, const TreeState<T>& state) {
  const Model<T>& model = method.dynamics().mechanism.model;
  const T share = T(0x1p-48) * T(static_cast<int>(model.body.size()) + 1);
  const Extent<T> at = extent(model, method.dynamics().place(state.t, state.q, state.v));
  return {T(share * at.reach), T(share * at.speed)};
}

}  // namespace

template <class T>
Drift<T> projected_drift(Method<T>& method, const std::vector<TreeState<T>>& states) {
  Drift<T> most{T(0), T(0)};
  for (const TreeState<T>& state : states) {
    const Drift<T> limit = projection_limit(method, state), noise = rounding(method, state, T(1), state, T(0)).noise;
    most = larger(most, {T(limit.position + noise.position), T(limit.velocity + noise.velocity)});
  }
  return most;
}

template <class T>
Drift<T> projection_error(Method<T>& method, const std::vector<TreeState<T>>& states) {
  using std::abs, std::sqrt;
  Dynamics<T>& dynamics = method.dynamics();
  const std::vector<bool> free(dynamics.mechanism.model.guide.size(), false);
  Drift<T> most{T(0), T(0)};
  for (const TreeState<T>& state : states) {
    const Drift<T> limit = projection_limit(method, state);
    dynamics.begin(dynamics.place(state.t, state.q, state.v));
    std::vector<T> errors = dynamics.constraint_errors(false);
    T moved(1);  // joints move by 1 where constraints do
    for (std::size_t period = 1; period <= 2; ++period) {
      for (std::size_t r = 0; r < errors.size(); ++r) {
        const bool holds = r < dynamics.mechanism.joint.size() + dynamics.mechanism.law.size();  // in the tree, exactly
        errors[r] = holds ? 0 : r / period % 2 == 0 ? 1 : -1;
      }
      const auto change = dynamics.least_change(errors, free);
      if (!change) continue;
      for (const T& x : dynamics.in_joints(*change)) moved = std::max(moved, T(abs(x)));
    }
    moved *= sqrt(T(static_cast<int>(errors.size())));
    most = larger(most, {T(moved * limit.position), T(2 * moved * limit.velocity)});
  }
  return most;
}

template <class T>
std::optional<Rounding<T>> largest_defect(Method<T>& method, Scheme scheme, const T& h,
                                          const std::vector<TreeState<T>>& states) {
  const Model<T>& model = method.dynamics().mechanism.model;
  const Map<T> R = drift_map(scheme, h, model.alpha, model.beta);
  Drift<T> most{T(0), T(0)};
  Rounding<T> rounded{most, most};
  for (const TreeState<T>& from : states) {
    TreeState<T> to;
    if (!Method<T>::goes_on(method.step(scheme, from, h, to))) return std::nullopt;
    const std::vector<Drift<T>> before = method.drift(from);
    std::vector<Drift<T>> defect = method.drift(to);
    for (std::size_t i = 0; i < defect.size(); ++i) {
      const Drift<T> carried = times(R, before[i]);
      defect[i] = {T(defect[i].position - carried.position), T(defect[i].velocity - carried.velocity)};
    }
    most = larger(most, largest(model, defect));
    const Rounding<T> here = rounding(method, from, h, to, accelerations_one_by_one(method, from));
    rounded = {larger(rounded.defect, here.defect), larger(rounded.noise, here.noise)};
  }
  rounded.defect.position += defect_margin * most.position;
  rounded.defect.velocity += defect_margin * most.velocity;
  return rounded;
}

template <class T>
std::optional<DriftBound<T>> drift_bound(Method<T>& method, Scheme scheme, const T& h, long steps,
                                         const TreeState<T>& start, const std::vector<TreeState<T>>& states) {
  const Model<T>& model = method.dynamics().mechanism.model;
  const Map<T> R = drift_map(scheme, h, model.alpha, model.beta);
  const auto found = largest_defect(method, scheme, h, states);
  if (!found) return std::nullopt;
  const Drift<T>& defect = found->defect;
  const Drift<T> at_start = largest(model, method.drift(start));
  const Propagation<T> p = propagation(R, steps);
  const Drift<T> kept = times(p.peak, at_start), gathered = times(p.sum, defect);
  const Drift<T> bound = {T(kept.position + gathered.position + found->noise.position),
                          T(kept.velocity + gathered.velocity + found->noise.velocity)};
  DriftBound<T> result{spectral_radius(R), false, defect, bound, std::nullopt};
  result.stable = result.radius < 1;
  if (result.stable) result.in_norm = norm_bound(R, model.beta, at_start, defect);
  return result;
}

template Rounding<Real> rounding(Method<Real>&, const TreeState<Real>&, const Real&, const TreeState<Real>&,
                                 const Real&);
template Drift<Real> projected_drift(Method<Real>&, const std::vector<TreeState<Real>>&);
template Drift<Real> projection_error(Method<Real>&, const std::vector<TreeState<Real>>&);
template std::optional<Rounding<Real>> largest_defect(Method<Real>&, Scheme, const Real&,
                                                      const std::vector<TreeState<Real>>&);
template std::optional<DriftBound<Real>> drift_bound(Method<Real>&, Scheme, const Real&, long, const TreeState<Real>&,
                                                     const std::vector<TreeState<Real>>&);

}  // namespace slideway::oracle
