// Runge-Kutta coefficients, for q'' = a(t, q, q').
#pragma once

namespace slideway {

/// An explicit method for y' = f(t, y): stage k at t + c_k h, y + h sum a_kj f_j; the step y + h sum b_j f_j. For
/// q'' = a(t, q, v) the stages' speeds are sums of accelerations again, so that positions need the accelerations alone:
///   v_k = v + h sum a_kj a_j,  q_k = q + c_k h v + h^2 sum aa_kj a_j,  aa = a a,
///   v+ = v + h sum b_j a_j,    q+ = q + h v + h^2 sum ba_j a_j,        ba = b a.
template <int Stages>
struct Tableau {
  static constexpr int stages = Stages;
  double a[Stages][Stages] = {}, b[Stages] = {};
  double doubt[2][Stages] =
      {};               ///< two sums of accelerations that vanish with the step: 0 to orders below the method's
  double doubtful = 0;  ///< the part of sum |b_k a_k| above which the doubts say that a step is too long
  double c[Stages] = {};
  double aa[Stages][Stages] = {}, ba[Stages] = {};
};

namespace detail {

template <int Stages>
constexpr Tableau<Stages> completed(Tableau<Stages> t) noexcept {
  for (int k = 0; k < Stages; ++k) {
    for (int j = 0; j < k; ++j) t.c[k] += t.a[k][j];
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < i; ++j) t.aa[k][j] += t.a[k][i] * t.a[i][j];
      t.ba[i] += t.b[k] * t.a[k][i];
    }
  }
  return t;
}

}  // namespace detail

// What is doubtful, by q'' = -w^2 q in any phase. rk4's doubts are at most 0.026 of the sum at h w = 1/6 and at least
// 0.038 at 2/3, where its own error is small. Those of order 8 are at most 0.0077 at h w = 1 and at least 0.0087 at 5;
// there the widest gap between its stages, 0.27 h, hides no more than an eighth of what the solution changes by.

/// Classical, order 4, in doubt by its two middle stages and by the midpoint rule (Kutta 1901; Hairer, Norsett and
/// Wanner, Solving Ordinary Differential Equations I, II.1).
inline constexpr Tableau<4> runge_kutta_4 =
    detail::completed<4>({{{0}, {0.5}, {0, 0.5}, {0, 0, 1}},
                          {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6},
                          {{0, -1, 1, 0}, {1.0 / 6, -2.0 / 3, 1.0 / 3, 1.0 / 6}},
                          1.0 / 32});

/// Order 8, in doubt by its embedded estimators of orders 3 and 5 (Dormand and Prince; Hairer, Norsett and Wanner I,
/// II.5 and II.10: DOP853).
inline constexpr Tableau<12> dormand_prince_8 = detail::completed<12>(
    {{{0},
      {0.05260015195876773},
      {0.0197250569845379, 0.0591751709536137},
      {0.02958758547680685, 0, 0.08876275643042054},
      {0.2413651341592667, 0, -0.8845494793282861, 0.924834003261792},
      {0.037037037037037035, 0, 0, 0.17082860872947386, 0.12546768756682242},
      {0.037109375, 0, 0, 0.17025221101954405, 0.06021653898045596, -0.017578125},
      {0.03709200011850479, 0, 0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
       0.008273789163814023},
      {0.6241109587160757, 0, 0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894,
       -43.48988418106996},
      {0.47766253643826434, 0, 0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423,
       -33.28821096898486, -0.020331201708508627},
      {-0.9371424300859873, 0, 0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696,
       22.739487099350505, 2.4936055526796523, -3.0467644718982196},
      {2.273310147516538, 0, 0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
       -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636}},
     {0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, 0.3111643669578199,
      -0.1521609496625161, 0.20136540080403034, 0.04471061572777259},
     {{-0.18980075407240762, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, -0.4226823213237919,
       -0.1521609496625161, 0.20136540080403034, 0.02265179219836082},
      {0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864,
       -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294}},
     1.0 / 128});

}  // namespace slideway
