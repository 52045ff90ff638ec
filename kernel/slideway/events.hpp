// What ends a mode, and where: a step whose modes are frozen, cut at each event.
//
// Inside a mode - slip directions, guides at rest, contact signs - the equations are smooth. It lasts while these are
// positive: mode v of each guide that slips, sign lambda of each contact, limit - |F| of each guide at rest. A stage
// solves one linear system, right or wrong. Where the stages' values come near zero the step's end is evaluated, and
// the time of the first zero is found as the length of a step that ends there: by the method itself, so to its
// accuracy.
//
// A function that is zero to rounding where a mode begins counts only once it has left zero; if it turns negative at
// once, its mode was wrong there: the next round begins at the same time.
#pragma once

#include <slideway/runge_kutta.hpp>
#include <slideway/verify.hpp>

namespace slideway {

inline constexpr int probes_to_find = 12, probes_to_locate = 64, most_pieces = 32;

/// Evaluations of a step by a located method with s stages: at most this for each of
/// max_events + contacts + guides + most_pieces + 1 rounds.
constexpr int evaluations_of_a_round(int stages) noexcept {
  return 2 + (1 + most_pieces + probes_to_find + probes_to_locate) * stages;
}

template <const auto& tableau, class Source>
class LocatedStep {
  using Size = typename Source::Size;
  static constexpr int n_contacts = Size::contacts, n_guides = Size::guides, jam = n_contacts + n_guides,
                       functions = jam + 1;

 public:
  LocatedStep(const Setting<Source>& setting, int max_events) noexcept
      : setting_(setting), source_(setting.source), max_events_(max_events) {}

  /// h further, from y with modes m; both are replaced. The report gets events and energies.
  Status run(double h, Phase<Size>& y, Modes<Size>& m) noexcept {
    double done = 0;
    int standing = 0;
    Modes<Size> before = m;
    for (int round = 0; round < max_events_ + n_contacts + n_guides + most_pieces + 1; ++round) {
      SLIDEWAY_CLAIM(0 <= done && done <= h);
      SLIDEWAY_CLAIM(setting_.report.evaluations <= round * evaluations_of_a_round(tableau.stages));
      const Status decided = begin(done, y, m);
      if (decided != Status::ok) return decided;
      if (!take_events(done, before, m)) return Status::event_limit;
      before = m;
      double left = h - done;
      if (!(left > resolution(done, 0))) return Status::ok;
      const Status tried = advance_resolved(done, left, y, m);
      if (tried != Status::ok) return tried;
      bool found = false;
      if (is_suspicious()) {
        const Status searched = search(done, left, y, m, found);
        if (searched != Status::ok) return searched;
      }
      const Phase<Size> from = y;
      add(setting_.report.energy, 1, found ? high_.flow : stages_.flow);
      y = found ? high_.to : stages_.to;
      if (!found && done + left >= h) return Status::ok;
      const double moved = found ? high_.s : left;
      standing = moved > resolution(done, 0) ? 0 : standing + 1;
      if (standing > n_contacts + n_guides) return Status::event_limit;
      done += moved;
      if (found) fire(done, from.v, y, m);
    }
    return Status::event_limit;
  }

 private:
  struct Values {
    double of[functions];
  };
  /// A step of length s that was made, and what its end is like.
  struct Probe {
    double s;
    Phase<Size> to;
    EnergyFlow flow;
    Values value;
  };

  /// Times closer than this are not told apart: some roundings of the time.
  double resolution(double done, double s) const noexcept {
    return 4 * detail::epsilon * (std::fabs(setting_.t) + done + s);
  }

  /// f(i) for every function that is watched.
  template <class F>
  SLIDEWAY_INLINE void each_watched(F&& f) const noexcept {
    for_each<Source, Size::contacts>(source_.tables.rough, [&](int i) SLIDEWAY_FOLD {
      const int c = source_.tables.rough_contact[i];
      if (watched_[c]) f(c);
    });
    for_each<Source, Size::guides>(source_.scene.guides, [&](int g) SLIDEWAY_FOLD {
      if (source_.tables.is_rough[g] && watched_[n_contacts + g]) f(n_contacts + g);
    });
  }

  SLIDEWAY_INLINE double value(int i, const Modes<Size>& m, const Reaction<Size>& r) const noexcept {
    if (i < n_contacts) return m.sign[i] < 0 ? -r.lambda[i] : r.lambda[i];
    const int g = i - n_contacts;
    return m.mode[g] > 0 ? r.slip[g] : m.mode[g] < 0 ? -r.slip[g] : m.limit_left[g];
  }

  /// Modes at the beginning of a round.
  Status begin(double done, const Phase<Size>& y, Modes<Size>& m) noexcept {
    const Status status = setting_.evaluate(done, y, Aim::decide, done == 0, m, first_);
    if (status != Status::ok) return status;
    jammed_ = false;
    for_each<Source, Size::guides>(source_.scene.guides, [&](int g) SLIDEWAY_FOLD {
      m.still[g] = m.leaving[g] = false;
      if (source_.tables.is_rough[g] && m.mode[g] == 0) jammed_ = jammed_ || !m.bound[g];
    });
    for_each<Source, Size::contacts>(source_.tables.rough, [&](int i) SLIDEWAY_FOLD {
      const int c = source_.tables.rough_contact[i], g = source_.tables.guide_of[c];
      const Guide& guide = source_.scene.guide[g];
      watched_[c] = m.mode[g] != 0 ? guide.mu > 0 : guide.mu_static > 0 && !jammed_;
      noise_[c] = m.noise(c);
    });
    m.decided = true;
    for_each<Source, Size::guides>(source_.scene.guides, [&](int g) SLIDEWAY_FOLD {
      if (!source_.tables.is_rough[g]) return;
      watched_[n_contacts + g] = m.mode[g] != 0 || !jammed_;
      const int c = source_.tables.first_contact[g];
      noise_[n_contacts + g] = 8 * detail::epsilon * std::fabs(first_.slip[g]);
      if (m.mode[g] != 0) return;
      double noise = 0;
      for (int i = 0; i < source_.scene.guide[g].contacts; ++i) noise += m.noise(c + i);
      noise_[n_contacts + g] = 2 * (1 + source_.scene.guide[g].mu_static) * noise;
    });
    each_watched([&](int i) SLIDEWAY_FOLD {
      start_.of[i] = value(i, m, first_);
      low_[i] = detail::infinity;
      high_value_[i] = start_.of[i];
    });
    return Status::ok;
  }

  /// The step of length s with frozen modes; lowest and highest values at its stages.
  Status advance(double done, double s, const Phase<Size>& y, const Modes<Size>& m) noexcept {
    each_watched([&](int i) SLIDEWAY_FOLD {
      low_[i] = detail::infinity;
      high_value_[i] = start_.of[i];
    });
    for_each<Source, Size::guides>(source_.scene.guides, [&](int g) SLIDEWAY_FOLD {
      if (!source_.tables.is_rough[g] || m.mode[g] == 0) return;
      noise_[n_contacts + g] =
          8 * detail::epsilon * std::fabs(first_.slip[g]) + s * m.motion_noise(source_.tables.first_contact[g]);
    });
    Modes<Size> frozen = m;
    return stages_.run(
        setting_, done, s, y, first_, Aim::follow, frozen, [](int) {},
        [&](int k, const Reaction<Size>& r) SLIDEWAY_FOLD {
          each_watched([&](int i) SLIDEWAY_FOLD {
            const double now = value(i, frozen, r);
            if (now < low_[i]) {
              low_[i] = now;
              low_at_[i] = k;
            }
            high_value_[i] = larger(high_value_[i], now);
          });
        });
  }

  /// The same of a length that the method resolves: halved, at most `most_pieces` times, while the functions vary and
  /// the method doubts it, or a stage is refused. So a step much longer than the motion's own times is cut,
  /// and runs into its limit.
  Status advance_resolved(double done, double& s, const Phase<Size>& y, const Modes<Size>& m) noexcept {
    Status status = advance(done, s, y, m);
    for (int k = 0; k < most_pieces && (status != Status::ok || is_too_long(s, y)); ++k) {
      if (!(0.5 * s > resolution(done, s))) return status;
      s *= 0.5;
      status = advance(done, s, y, m);
    }
    return status;
  }

  /// Is the step of length s from y, that was made, longer than what it is meant to see?
  bool is_too_long(double s, const Phase<Size>& y) const noexcept {
    return turns_far(source_, y.q, stages_.to.q) || (vary() && stages_.is_too_long(source_, s));
  }

  /// Does a function change by more than an eighth of itself?
  bool vary() const noexcept {
    bool any = false;
    each_watched([&](int i) SLIDEWAY_FOLD {
      const double range = high_value_[i] - (low_[i] < start_.of[i] ? low_[i] : start_.of[i]);
      any |= range > 0.125 * high_value_[i] && range > noise_[i];
    });
    return any;
  }

  /// Does a function come nearer to zero than an eighth of what it changes by? Stages are off the solution by a higher
  /// order of the step than that.
  bool is_suspicious() const noexcept {
    bool any = jammed_;
    each_watched([&](int i) SLIDEWAY_FOLD {
      const bool armed = start_.of[i] > noise_[i];
      const double low = armed && start_.of[i] < low_[i] ? start_.of[i] : low_[i];
      any |= low - 0.125 * (high_value_[i] - low) < -noise_[i];
    });
    return any;
  }

  /// What the end of the step of length s that was made is like.
  Status look(double done, double s, const Modes<Size>& m, Probe& probe) noexcept {
    Modes<Size> ends = m;
    Reaction<Size> r;
    probe.s = s;
    probe.to = stages_.to;
    probe.flow = stages_.flow;
    Report& report = setting_.report;
    const Uniqueness uniqueness = report.uniqueness;
    const int guide = report.guide;
    const Status status = setting_.evaluate(done + s, probe.to, jammed_ ? Aim::decide : Aim::follow, false, ends, r);
    report.uniqueness = uniqueness;  // of what is decided there, the next round speaks
    report.guide = guide;
    probe.value.of[jam] = 1;
    if (jammed_) {
      bool same = status == Status::ok;
      for (int g = 0; g < source_.scene.guides; ++g) same = same && (m.mode[g] != 0 || ends.mode[g] == 0);
      if (!same) {
        probe.value.of[jam] = -1;
        each_watched([&](int i) { probe.value.of[i] = std::fabs(start_.of[i]); });  // nothing is known of them
        return Status::ok;
      }
      for (int g = 0; g < source_.scene.guides; ++g) ends.mode[g] = m.mode[g];
      for (int c = 0; c < source_.tables.contacts; ++c) ends.sign[c] = m.sign[c];
    }
    if (status != Status::ok) return status;
    friction_ = r;
    each_watched([&](int i) { probe.value.of[i] = value(i, ends, r); });
    return status;
  }

  Status probe(double done, double s, const Phase<Size>& y, const Modes<Size>& m, Probe& result) noexcept {
    const Status status = advance(done, s, y, m);
    return status == Status::ok ? look(done, s, m, result) : status;
  }

  bool is_over(const Values& value) const noexcept {
    bool over = jammed_ && value.of[jam] < 0;
    each_watched([&](int i) { over = over || value.of[i] < -noise_[i]; });
    return over;
  }

  /// Looks for an end of the mode within the step that was tried; locates the first into high_. Without one the step
  /// as tried is in stages_.
  Status search(double done, double left, const Phase<Size>& y, const Modes<Size>& m, bool& found) noexcept {
    double dips[functions];
    int places = 0;
    each_watched([&](int i) {
      range_[i] = high_value_[i] - low_[i];
      if (low_[i] - 0.125 * (high_value_[i] - low_[i]) < -noise_[i] && tableau.c[low_at_[i]] < 1) {
        dips[places++] = tableau.c[low_at_[i]] * left;
      }
    });
    Status status = look(done, left, m, high_);
    if (status != Status::ok) return status;
    found = is_over(high_.value);
    const Probe whole = high_;
    for (int k = 0; k < places && 2 * k < probes_to_find && !found; ++k) {
      status = probe(done, dips[k], y, m, high_);
      if (status != Status::ok) return status;
      found = is_over(high_.value);
      if (found) continue;
      const double nearer = lowest(start_, dips[k], high_.value, left, whole.value);
      if (!(nearer > 0 && nearer < left)) continue;
      status = probe(done, nearer, y, m, high_);
      if (status != Status::ok) return status;
      found = is_over(high_.value);
    }
    SLIDEWAY_CLAIM(0 < high_.s && high_.s <= left);
    if (found) return locate(done, left, y, m);
    stages_.to = whole.to;
    stages_.flow = whole.flow;
    return Status::ok;
  }

  /// Where the parabola through three times of the function that is lowest at the middle one has its minimum.
  double lowest(const Values& a, double s, const Values& b, double left, const Values& c) const noexcept {
    double at = -1, least = detail::infinity;
    each_watched([&](int i) {
      const double slope_1 = (b.of[i] - a.of[i]) / s, slope_2 = (c.of[i] - b.of[i]) / (left - s);
      const double bend = (slope_2 - slope_1) / left;
      const double size = larger(std::fabs(a.of[i]), std::fabs(c.of[i])) + noise_[i];
      if (!(bend > 0) || detail::quotient(b.of[i], size) >= least) return;
      least = detail::quotient(b.of[i], size);
      at = 0.5 * (s - slope_1 / bend);
    });
    return at;
  }

  /// Brings the end of high_, which is over, to the first zero: low end and high end of a bracket; inverse quadratic
  /// interpolation by the function that is estimated to vanish first, bisection when that does not halve the bracket in
  /// three probes. Refused where forces change their sign through infinity.
  Status locate(double done, double left, const Phase<Size>& y, const Modes<Size>& m) noexcept {
    double low = 0, third = 0, width = high_.s;
    Values at_low = start_, at_third = start_;
    each_watched([&](int i) {
      if (at_low.of[i] < 0) at_low.of[i] = 0;
    });
    bool have_third = false;
    int lows = 0, highs = 0;  // probes in a row that have moved that end
    for (int k = 0; k < probes_to_locate; ++k) {
      SLIDEWAY_CLAIM(0 <= low && low < high_.s && is_negative(high_.value));
      const double near = resolution(done, high_.s);
      if (high_.s - low <= near) break;
      if (k % 3 == 0) {  // halved, but for the distance that is kept from its ends
        SLIDEWAY_CLAIM(k == 0 || high_.s - low <= 0.5 * width + near);
        width = high_.s - low;
      }
      double s = estimate(low, at_low, high_.s, high_.value, third, at_third, have_third);
      // Estimates that stay on one side of the zero leave the other end where it is: twice as far is beyond it.
      if (lows > 1) s = low + 2 * (s - low);
      if (highs > 1) s = high_.s - 2 * (high_.s - s);
      if (k % 3 == 2 && high_.s - low > 0.5 * width) s = low + 0.5 * (high_.s - low);
      if (!(s > low + 0.5 * near)) s = low + 0.5 * near;
      if (!(s < high_.s - 0.5 * near)) s = high_.s - 0.5 * near;
      if (!(s > low && s < high_.s)) break;
      Probe now;
      const Status status = probe(done, s, y, m, now);
      if (status != Status::ok) return status;
      have_third = true;
      if (is_negative(now.value)) {
        third = high_.s;
        at_third = high_.value;
        high_ = now;
        ++highs;
        lows = 0;
      } else {
        third = low;
        at_third = at_low;
        low = s;
        at_low = now.value;
        ++lows;
        highs = 0;
      }
    }
    return has_pole(done, left, at_low) ? Status::singular_constraints : Status::ok;
  }

  /// Does a contact force or a limit change by an eighth of what it changed by in the whole step between the ends of
  /// the bracket, which are some roundings of the time apart? Then friction has made the contacts' matrix singular
  /// there.
  bool has_pole(double done, double left, const Values& at_low) const noexcept {
    bool pole = false;
    if (!(left > 0x1p10 * resolution(done, left))) return false;
    each_watched([&](int i) {
      const double jump = at_low.of[i] - high_.value.of[i];
      if (!(high_.value.of[i] < 0) || !(jump > 0.125 * range_[i] && jump > noise_[i])) return;
      setting_.report.guide = i < n_contacts ? source_.tables.guide_of[i] : i - n_contacts;
      pole = true;
    });
    return pole;
  }

  bool is_negative(const Values& value) const noexcept {
    bool over = jammed_ && value.of[jam] < 0;
    each_watched([&](int i) { over = over || (value.of[i] < 0 && high_.value.of[i] < 0); });
    return over;
  }

  /// The least estimate of a zero of the functions that are negative at the high end.
  double estimate(double low, const Values& at_low, double high, const Values& at_high, double third,
                  const Values& at_third, bool have_third) const noexcept {
    double least = 0.5 * (low + high);
    bool any = false;
    each_watched([&](int i) {
      const double a = at_low.of[i], b = at_high.of[i], c = at_third.of[i];
      if (!(b < 0)) return;
      // Zero where a probe was: it ends there. Zero where the round begins: it goes on first.
      double s = a > 0 ? low + (high - low) * (a / (a - b)) : low > 0 ? low : low + (high - low) / 16;
      if (have_third && a > 0 && c != a && c != b) {
        using detail::quotient;
        const double inverse = quotient(low * b * c, (a - b) * (a - c)) + quotient(high * a * c, (b - a) * (b - c)) +
                               quotient(third * a * b, (c - a) * (c - b));
        if (inverse > low && inverse < high) s = inverse;
      }
      if (!any || s < least) least = s;
      any = true;
    });
    return least;
  }

  /// Ends the modes whose functions have reached zero at y; the round began with speeds `from`.
  void fire(double done, const double* from, Phase<Size>& y, Modes<Size>& m) noexcept {
    const double near = 8 * resolution(done, 0);
    bool stops = false;
    signed char moves[at_least_one(n_guides)];
    for (int g = 0; g < n_guides; ++g) moves[g] = 1;
    each_watched([&](int i) {
      const double v = high_.value.of[i];
      // What changes at the mean rate of the round so far, and is that near to zero, is taken along.
      const double rate = high_.s > 0 ? (start_.of[i] - v) / high_.s : 0;
      if (!(v < 0 || (rate > 0 && v <= larger(noise_[i], near * rate)))) return;
      if (i < n_contacts) {
        m.sign[i] = static_cast<signed char>(m.sign[i] < 0 ? 1 : -1);
        return;
      }
      const int g = i - n_contacts;
      m.still[g] = stops = true;
      moves[g] = 0;
      if (m.mode[g] != 0) {
        m.mode[g] = 0;
      } else {
        m.mode[g] = friction_.friction[g] > 0 ? -1 : 1;
        m.leaving[g] = true;
      }
    });
    // What is left of those speeds is rounding: 2^-20 of the motion is far above that, and below any motion meant.
    if (stops) Projection<Source>(source_, setting_.inputs, done, y.q, y.v).arrest(moves, 0x1p-20, from);
  }

  /// Events between two modes at one time. False when there are more than allowed.
  bool take_events(double done, const Modes<Size>& before, const Modes<Size>& now) noexcept {
    bool room = true;
    const auto take = [&](int g, int contact, EventKind kind) {
      Report& report = setting_.report;
      room = room && report.events < max_events_;
      if (!room) return;
      report.event[report.events++] = {setting_.t + done, g, contact, kind};
    };
    if (!before.decided) return true;
    for_each<Source, Size::guides>(source_.scene.guides, [&](int g) SLIDEWAY_FOLD {
      if (!source_.tables.is_rough[g] || before.mode[g] == now.mode[g]) return;
      take(g, none,
           now.mode[g] == 0      ? EventKind::stick
           : before.mode[g] == 0 ? EventKind::slip
                                 : EventKind::slip_reversal);
    });
    for_each<Source, Size::contacts>(source_.tables.rough, [&](int i) SLIDEWAY_FOLD {
      const int c = source_.tables.rough_contact[i], g = source_.tables.guide_of[c];
      if (before.sign[c] == now.sign[c] || !(source_.scene.guide[g].mu_static > 0)) return;
      take(g, c - source_.tables.first_contact[g], EventKind::normal_reversal);
    });
    return room;
  }

  const Setting<Source>& setting_;
  const Source& source_;
  int max_events_;
  Reaction<Size> first_;     ///< where the round begins
  Reaction<Size> friction_;  ///< where it ends
  Stages<tableau, Source> stages_;
  Probe high_;
  Values start_;
  double low_[functions], high_value_[functions], noise_[functions], range_[functions];
  int low_at_[functions];
  bool watched_[functions], jammed_ = false;
};

}  // namespace slideway
