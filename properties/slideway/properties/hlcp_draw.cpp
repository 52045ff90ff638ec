// Problems of every kind.
#include <cmath>
#include <slideway/properties/hlcp.hpp>

namespace slideway::properties {
namespace {

void set_row_of(HlcpCase& problem, int i, int like, double factor) {
  for (int j = 0; j < problem.n; ++j) {
    problem.data.plus[i][j] = factor * problem.data.plus[like][j];
    problem.data.minus[i][j] = factor * problem.data.minus[like][j];
  }
}

/// b of a problem that x, dyadic with `zeros` among its entries, solves.
void plant(Choices& choices, HlcpCase& problem, bool zeros) {
  double x[hlcp_max_order];
  for (int k = 0; k < problem.n; ++k) {
    x[k] = choices.dyadic(3);
    if (zeros && choices.flag()) x[k] = 0;
  }
  for (int i = 0; i < problem.n; ++i) {
    problem.data.b[i] = 0;
    for (int j = 0; j < problem.n; ++j) {
      problem.data.b[i] += (x[j] < 0 ? problem.data.minus[i][j] : problem.data.plus[i][j]) * x[j];
    }
  }
}

void fill(Choices& choices, HlcpCase& problem, int places) {
  for (int i = 0; i < problem.n; ++i) {
    for (int j = 0; j < problem.n; ++j) {
      problem.data.plus[i][j] = choices.dyadic(places);
      problem.data.minus[i][j] = choices.dyadic(places);
    }
    problem.data.b[i] = choices.dyadic(places);
  }
}

/// S = N N' + D, S* of entries up to `strength` quarters of S's.
void fill_friction(Choices& choices, HlcpCase& problem, double strength) {
  const int n = problem.n;
  double N[hlcp_max_order][hlcp_max_order];
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) N[i][k] = choices.dyadic(5);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double S = i == j ? choices.positive(5) : 0;
      for (int k = 0; k < n; ++k) S += N[i][k] * N[j][k];
      const double S_star = strength * choices.dyadic(5);
      problem.data.plus[i][j] = S + S_star;
      problem.data.minus[i][j] = S - S_star;
    }
    problem.data.b[i] = choices.dyadic(4);
  }
}

/// A strength that leaves the W-property: 2^-4 over the order, or the next power of two, so that entries keep few bits.
double weak(int n) {
  double strength = 0x1p-4;
  for (int k = 1; k < n; k *= 2) strength /= 2;
  return strength;
}

void fill_textbook(Choices& choices, HlcpCase& problem) {
  const int n = problem.n, which = choices.below(6);
  double m[hlcp_max_order * hlcp_max_order] = {}, q[hlcp_max_order] = {};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double& entry = m[i * n + j];
      if (which == 0) entry = j < i ? 2 : j == i ? 1 : 0;                     // Murty
      if (which == 1) entry = j > i ? 2 : j == i ? 1 : 0;                     // its transpose
      if (which == 2) entry = 4 * (i < j ? i : j) + (i == j ? 1 : 2);         // Fathi: M M' of Murty's, rows from 0
      if (which == 3) entry = j == i ? 1 : j == (i + 1) % n ? 2 : 0;          // Kostreva, of any order
      if (which == 4) entry = j == i ? 1 : j == (i + n - 1) % n ? 1.125 : 0;  // sign iteration cycles (n = 3)
      if (which == 5) entry = j == i ? 1 : j == (i + 1) % n ? -1 : 0;         // singular: rows add up to nothing
    }
    q[i] = choices.flag() ? choices.dyadic(2) : -1;
  }
  problem = lcp_case(n, m, q);
  if (which != 4) return;
  // S = I + C, S* = C - I: A+ = 2 C, A- = 2 I, b = 2.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      problem.data.plus[i][j] = 2 * m[i * n + j];
      problem.data.minus[i][j] = i == j ? 2 : 0;
    }
    problem.data.b[i] = 2;
  }
}

void scale(Choices& choices, HlcpCase& problem) {
  for (int i = 0; i < problem.n; ++i) {
    const double factor = std::ldexp(1, choices.below(121) - 60);
    for (int j = 0; j < problem.n; ++j) {
      problem.data.plus[i][j] *= factor;
      problem.data.minus[i][j] *= factor;
    }
    problem.data.b[i] *= factor;
  }
  const double right = std::ldexp(1, choices.below(121) - 60);
  for (int i = 0; i < problem.n; ++i) problem.data.b[i] *= right;
}

/// 1 but for the last bits: 2^-52 to 2^-27, that is 1.5e-8.
double nearly_one(Choices& choices) {
  const double sign = choices.flag() ? 1 : -1;  // not beside the next: arguments have no order
  return 1 + std::ldexp(sign, -27 - choices.below(26));
}

/// Some entries.
void disturb(Choices& choices, HlcpCase& problem) {
  for (int i = 0; i < problem.n; ++i) {
    for (int j = 0; j < problem.n; ++j) {
      if (choices.flag()) problem.data.plus[i][j] *= nearly_one(choices);
    }
    if (choices.flag()) problem.data.b[i] *= nearly_one(choices);
  }
}

}  // namespace

const char* name(HlcpKind kind) {
  switch (kind) {
    case HlcpKind::small_integers:
      return "small integers";
    case HlcpKind::dyadic:
      return "dyadic";
    case HlcpKind::lcp:
      return "lcp";
    case HlcpKind::friction:
      return "friction";
    case HlcpKind::strong:
      return "strong";
    case HlcpKind::singular:
      return "singular";
    case HlcpKind::degenerate:
      return "degenerate";
    case HlcpKind::scaled:
      return "scaled";
    case HlcpKind::nearly:
      return "nearly";
    case HlcpKind::textbook:
      return "textbook";
  }
  return "unknown";
}

HlcpCase draw_hlcp(Choices& choices, HlcpKind kind, int most_order) {
  HlcpCase problem{1 + choices.below(most_order), {}};
  switch (kind) {
    case HlcpKind::small_integers: {
      for (int i = 0; i < problem.n; ++i) {
        for (int j = 0; j < problem.n; ++j) {
          problem.data.plus[i][j] = choices.below(3) - 1;
          problem.data.minus[i][j] = choices.below(3) - 1;
        }
        problem.data.b[i] = choices.below(3) - 1;
      }
      break;
    }
    case HlcpKind::dyadic:
      fill(choices, problem, 3);
      break;
    case HlcpKind::lcp: {
      fill(choices, problem, 3);
      const bool dominant = choices.flag();  // then the W-property holds
      for (int i = 0; i < problem.n; ++i) {
        if (dominant) problem.data.minus[i][i] = 16 * problem.n + std::fabs(problem.data.minus[i][i]);
        for (int j = 0; j < problem.n; ++j) problem.data.plus[i][j] = i == j ? 1 : 0;
      }
      break;
    }
    case HlcpKind::friction:
      fill_friction(choices, problem, weak(problem.n));
      break;
    case HlcpKind::strong:
      fill_friction(choices, problem, 0.5);
      break;
    case HlcpKind::singular:
      fill(choices, problem, 3);
      if (problem.n > 1) set_row_of(problem, problem.n - 1, 0, 1 + choices.below(3));
      if (choices.flag()) plant(choices, problem, false);
      break;
    case HlcpKind::degenerate:
      if (choices.flag()) {
        fill_friction(choices, problem, weak(problem.n));
      } else {
        fill(choices, problem, 2);
      }
      plant(choices, problem, true);
      break;
    case HlcpKind::scaled:
      fill_friction(choices, problem, choices.flag() ? 0.5 : 0x1p-4);
      if (choices.flag()) plant(choices, problem, true);
      scale(choices, problem);
      break;
    case HlcpKind::nearly:
      fill(choices, problem, 2);
      if (problem.n > 1 && choices.flag()) set_row_of(problem, problem.n - 1, 0, 1);
      plant(choices, problem, true);
      disturb(choices, problem);
      break;
    case HlcpKind::textbook:
      fill_textbook(choices, problem);
      break;
  }
  return problem;
}

unsigned long long small_hlcps(int n, bool is_lcp) {
  unsigned long long count = 1;
  for (int k = 0; k < n * (is_lcp ? n + 1 : 2 * n + 1); ++k) count *= 3;
  return count;
}

HlcpCase small_hlcp(int n, unsigned long long code, bool is_lcp) {
  HlcpCase problem{n, {}};
  const auto next = [&] {
    const auto digit = static_cast<int>(code % 3);
    code /= 3;
    return digit == 2 ? -1.0 : digit;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      problem.data.plus[i][j] = is_lcp ? (i == j ? 1 : 0) : next();
      problem.data.minus[i][j] = next();
    }
    problem.data.b[i] = next();
  }
  return problem;
}

}  // namespace slideway::properties
