// What a scene's data imply for the loops of the kernel: index lists and structural zeros, the two sources of a scene
// (compile time and run time), and the loop that folds when the scene is known to the compiler.
#pragma once

#include <slideway/scene.hpp>
#include <type_traits>
#include <utility>

#if defined(__GNUC__)
#define SLIDEWAY_INLINE inline __attribute__((always_inline))
#define SLIDEWAY_FOLD __attribute__((always_inline))                                 // behind a lambda's parameters
#define SLIDEWAY_ASSUME(condition) ((condition) ? void() : __builtin_unreachable())  // the counts of derived tables
#else
#define SLIDEWAY_INLINE inline
#define SLIDEWAY_FOLD
#define SLIDEWAY_ASSUME(condition) void()
#endif

namespace slideway {

/// Which components of a fixed vector can be other than zero: adding an exact zero changes nothing, so it is left out.
struct Axes {
  bool x = false, y = false;
  constexpr bool any() const noexcept { return x || y; }
};

constexpr Axes axes(Vec2 r) noexcept { return {r.x != 0, r.y != 0}; }

/// How a coordinate moves its body: about the joint, or along the joint frame's x or y axis.
enum class Motion : unsigned char { turn, slide_x, slide_y };

using Index = short;

/// The coordinates that move two joined bodies against each other: a guide's slider a and rail b, or a pin's a and b.
template <class Size>
struct Link {
  Index columns = 0;  ///< coordinates that move a or b, not both alike
  Index column[at_least_one(Size::coordinates)] = {};
  Index side[at_least_one(Size::coordinates)] = {};  ///< +1 moves a, -1 moves b
  Index fills = 0;  ///< free coordinates that the row reaches in the mass metric, clear of the ideal rows
  Index fill[at_least_one(Size::coordinates)] = {};
  bool filled[at_least_one(Size::coordinates)] = {};
};

/// Derived tables: nothing that the scene does not already say.
template <class Size>
struct Tables {
  static constexpr int n_bodies = at_least_one(Size::bodies), n_coordinates = at_least_one(Size::coordinates),
                       n_guides = at_least_one(Size::guides), n_contacts = at_least_one(Size::contacts),
                       n_ideal = 2 * at_least_one(Size::pins) + Size::contacts;

  // coordinates, body by body; the free ones (no drive on them) have a number of their own
  Index coordinates = 0, free = 0;
  Index first[n_bodies] = {};  ///< a body's first coordinate
  Index body_of[n_coordinates] = {};
  Motion motion[n_coordinates] = {};
  Index drive_of[n_coordinates] = {};  ///< or none
  Index free_of[n_coordinates] = {};   ///< or none
  Index free_coordinate[n_coordinates] = {};
  Index every[n_coordinates] = {};  ///< 0, 1, 2, ...
  Index ups[n_coordinates] = {};    ///< free coordinates nearer to the ground on the path of a free coordinate
  Index up[n_coordinates][n_coordinates] = {};

  // contacts, guide by guide; those of rough guides (mu_static > 0 or preload > 0: they can stick) are the unknowns of
  // the HLCPs, the others are ideal rows
  Index contacts = 0, rough = 0, ideal = 0;  ///< ideal rows: two a pin, then one a contact of a guide that is not rough
  Index first_contact[n_guides] = {};
  Index guide_of[n_contacts] = {};
  Index row_of[n_contacts] = {};         ///< in its part's HLCP, or among the ideal rows; one after another in a guide
  Index rough_contact[n_contacts] = {};  ///< part by part
  bool is_rough[n_guides] = {};
  bool is_steady[n_guides] = {};  ///< has friction that does not follow its load: viscous or preload
  Index steady = 0;               ///< such guides
  Link<Size> guide[n_guides] = {};
  Link<Size> pin[at_least_one(Size::pins)] = {};

  // parts: free coordinates that links tie together, and the guides on them. Rows of two parts share no coordinate, so
  // they are orthogonal in the mass metric, and every part has an HLCP of its own.
  Index parts = 0, most_rows = 0, most_guides = 0;  ///< rough contacts and rough guides of the largest part
  Index part_of[n_coordinates] = {};                ///< of a free coordinate
  Index part_of_ideal[n_ideal] = {};                ///< of an ideal row
  bool has_ideal[n_coordinates] = {};               ///< has a part any?
  Index first_in_part[n_coordinates + 1] = {}, in_part[n_coordinates] = {};  ///< free coordinates, part by part
  Index first_guide[n_coordinates + 1] = {}, rough_guide[n_guides] = {};     ///< rough guides, part by part
  Index first_row[n_coordinates + 1] = {};                                   ///< into rough_contact

  // structural zeros
  Axes at[n_bodies] = {}, com[n_bodies] = {};
  Axes origin[n_guides] = {}, tangent[n_guides] = {}, contact[n_guides] = {}, span_axes[n_guides] = {};
  bool turned[n_bodies] = {};          ///< by a fixed angle
  bool turning[n_bodies] = {};         ///< the body's angular speed can be other than zero
  bool known_turning[n_bodies] = {};   ///< ... by a drive
  bool freely_turning[n_bodies] = {};  ///< ... by a free coordinate
  bool moving[n_bodies] = {};          ///< the origin's speed can be other than zero
  bool freely_moving[n_bodies] = {};   ///< ... by a free coordinate
  bool off_centre[n_bodies] = {};      ///< mass of the body and all it carries, off its origin
  bool applied[n_bodies] = {};         ///< springs, loads, or viscous or preload friction act on the body

  // constant sums
  double carried_mass[n_bodies] = {};    ///< of the body and all that it carries, kg
  double origin_inertia[n_bodies] = {};  ///< of the body alone about its origin, kg m^2
  double arm_squared[n_bodies] = {};     ///< |at|^2, m^2
  Vec2 span[n_guides] = {};              ///< from a guide's first contact to its second, slider's frame, m
  double length = 1;                     ///< the scene's length: the largest distance in its data, m
};

namespace detail {

constexpr double squared(Vec2 r) noexcept { return r.x * r.x + r.y * r.y; }

/// Square root by Newton's method from above, for a length scale in constant expressions: 1e-3 is accuracy enough. From
/// a power of two, so that another unit of length by a power of two gives the same bits.
constexpr double rough_sqrt(double x) noexcept {
  if (!(x > 1e-300) || !(x < 1e300)) return x;
  double root = 1;
  for (int k = 0; k < 500 && root * root < x; ++k) root *= 2;
  for (int k = 0; k < 500 && root * root > 4 * x; ++k) root /= 2;
  for (int k = 0; k < 8 && root * root > 1.001 * x; ++k) root = (root + x / root) / 2;
  return root;
}

template <class Size>
constexpr void derive_coordinates(const Scene<Size>& scene, Tables<Size>& t) noexcept {
  int j = 0;
  for (int i = 0; i < scene.bodies; ++i) {
    const Joint joint = scene.body[i].joint;
    t.first[i] = static_cast<Index>(j);
    for (int k = 0; k < coordinates(joint); ++k, ++j) {
      t.body_of[j] = static_cast<Index>(i);
      t.motion[j] = joint == Joint::revolute || k == 2 ? Motion::turn : k == 1 ? Motion::slide_y : Motion::slide_x;
      t.drive_of[j] = t.free_of[j] = none;
    }
  }
  t.coordinates = static_cast<Index>(j);
  for (int d = 0; d < scene.drives; ++d) {
    t.drive_of[t.first[scene.drive[d].body] + scene.drive[d].axis] = static_cast<Index>(d);
  }
  for (int c = 0; c < j; ++c) {
    if (t.drive_of[c] != none) continue;
    t.free_of[c] = t.every[t.free] = t.free;
    t.free_coordinate[t.free++] = static_cast<Index>(c);
  }
}

/// Does coordinate j move body i?
template <class Size>
constexpr bool moves(const Scene<Size>& scene, const Tables<Size>& t, int j, int i) noexcept {
  int body = i;
  for (int k = 0; k < scene.bodies && body != ground; ++k) {
    if (t.body_of[j] == body) return true;
    body = scene.body[body].parent;
  }
  return false;
}

template <class Size>
constexpr void derive_ups(const Scene<Size>& scene, Tables<Size>& t) noexcept {
  for (int f = 0; f < t.free; ++f) {
    const int body = t.body_of[t.free_coordinate[f]];
    for (int e = 0; e < f; ++e) {
      if (moves(scene, t, t.free_coordinate[e], body)) t.up[f][t.ups[f]++] = static_cast<Index>(e);
    }
  }
}

template <class Size>
constexpr Link<Size> link(const Scene<Size>& scene, const Tables<Size>& t, int a, int b) noexcept {
  Link<Size> l;
  for (int j = 0; j < t.coordinates; ++j) {
    const bool moves_a = moves(scene, t, j, a), moves_b = moves(scene, t, j, b);
    if (moves_a != moves_b) {
      l.column[l.columns] = static_cast<Index>(j);
      l.side[l.columns++] = moves_a ? 1 : -1;
    }
    const int f = t.free_of[j];
    if (f != none && (moves_a || moves_b)) {
      l.filled[f] = true;
      l.fill[l.fills++] = static_cast<Index>(f);
    }
  }
  return l;
}

template <class Size>
constexpr void derive_links(const Scene<Size>& scene, Tables<Size>& t) noexcept {
  t.ideal = static_cast<Index>(2 * scene.pins);
  for (int g = 0; g < scene.guides; ++g) {
    t.is_rough[g] = scene.guide[g].mu_static > 0 || scene.guide[g].preload > 0;
    t.is_steady[g] = scene.guide[g].viscous > 0 || scene.guide[g].preload > 0;
    if (t.is_steady[g]) ++t.steady;
    t.first_contact[g] = t.contacts;
    for (int c = 0; c < scene.guide[g].contacts; ++c) {
      const Index k = t.contacts++;
      t.guide_of[k] = static_cast<Index>(g);
      if (t.is_rough[g]) {
        ++t.rough;
      } else {
        t.row_of[k] = t.ideal++;
      }
    }
  }
  for (int g = 0; g < scene.guides; ++g) {
    t.guide[g] = link(scene, t, scene.guide[g].slider, scene.guide[g].rail);
    t.origin[g] = axes(scene.guide[g].origin);
    t.tangent[g] = axes(scene.guide[g].tangent);
    t.contact[g] = axes(scene.guide[g].contact[0]);
    if (scene.guide[g].contacts == 2) {
      t.span[g] = {scene.guide[g].contact[1].x - scene.guide[g].contact[0].x,
                   scene.guide[g].contact[1].y - scene.guide[g].contact[0].y};
      t.span_axes[g] = axes(t.span[g]);
    }
  }
  for (int p = 0; p < scene.pins; ++p) t.pin[p] = link(scene, t, scene.pin[p].a, scene.pin[p].b);
}

/// Which free coordinates links tie together: the least of them names all.
template <class Size>
constexpr void tie(const Link<Size>& l, Index free, Index* name) noexcept {
  for (int e = 1; e < l.fills; ++e) {
    const Index a = name[l.fill[0]], b = name[l.fill[e]];
    for (int f = 0; f < free; ++f) {
      if (name[f] == a || name[f] == b) name[f] = a < b ? a : b;
    }
  }
}

/// A link that reaches no free coordinate counts to the first part.
template <class Size>
constexpr Index part_of(const Tables<Size>& t, const Link<Size>& l) noexcept {
  return l.fills == 0 ? Index{0} : t.part_of[l.fill[0]];
}

/// With ideal rows to be clear of, a row reaches every coordinate of its part.
template <class Size>
constexpr void fill_part(const Tables<Size>& t, Link<Size>& l) noexcept {
  const int part = part_of(t, l);
  if (!t.has_ideal[part]) return;
  l.fills = 0;
  for (int i = t.first_in_part[part]; i < t.first_in_part[part + 1]; ++i) {
    l.filled[t.in_part[i]] = true;
    l.fill[l.fills++] = t.in_part[i];
  }
}

template <class Size>
constexpr void derive_parts(const Scene<Size>& scene, Tables<Size>& t) noexcept {
  constexpr int n = Tables<Size>::n_coordinates;
  Index name[n] = {};
  for (int f = 0; f < t.free; ++f) name[f] = static_cast<Index>(f);
  for (int g = 0; g < scene.guides; ++g) tie(t.guide[g], t.free, name);
  for (int p = 0; p < scene.pins; ++p) tie(t.pin[p], t.free, name);
  for (int f = 0; f < t.free; ++f) t.part_of[f] = name[f] == f ? t.parts++ : t.part_of[name[f]];
  if (t.parts == 0) t.parts = 1;

  for (int p = 0; p < scene.pins; ++p) {
    t.part_of_ideal[2 * p] = t.part_of_ideal[2 * p + 1] = part_of(t, t.pin[p]);
    t.has_ideal[part_of(t, t.pin[p])] = true;
  }
  for (int g = 0; g < scene.guides; ++g) {
    if (t.is_rough[g]) continue;
    for (int c = 0; c < scene.guide[g].contacts; ++c) {
      t.part_of_ideal[t.row_of[t.first_contact[g] + c]] = part_of(t, t.guide[g]);
    }
    t.has_ideal[part_of(t, t.guide[g])] = true;
  }
  Index coordinates = 0, guides = 0, rows = 0;
  for (int part = 0; part < t.parts; ++part) {
    t.first_in_part[part] = coordinates;
    t.first_guide[part] = guides;
    t.first_row[part] = rows;
    for (int f = 0; f < t.free; ++f) {
      if (t.part_of[f] == part) t.in_part[coordinates++] = static_cast<Index>(f);
    }
    for (int g = 0; g < scene.guides; ++g) {
      if (!t.is_rough[g] || part_of(t, t.guide[g]) != part) continue;
      t.rough_guide[guides++] = static_cast<Index>(g);
      for (int c = 0; c < scene.guide[g].contacts; ++c) {
        t.row_of[t.first_contact[g] + c] = static_cast<Index>(rows - t.first_row[part]);
        t.rough_contact[rows++] = static_cast<Index>(t.first_contact[g] + c);
      }
    }
    t.first_in_part[part + 1] = coordinates;
    t.first_guide[part + 1] = guides;
    t.first_row[part + 1] = rows;
    const Index most_rows = static_cast<Index>(rows - t.first_row[part]);
    const Index most_guides = static_cast<Index>(guides - t.first_guide[part]);
    t.most_rows = most_rows > t.most_rows ? most_rows : t.most_rows;
    t.most_guides = most_guides > t.most_guides ? most_guides : t.most_guides;
  }
  for (int g = 0; g < scene.guides; ++g) fill_part(t, t.guide[g]);
  for (int p = 0; p < scene.pins; ++p) fill_part(t, t.pin[p]);
}

template <class Size>
constexpr void derive_zeros(const Scene<Size>& scene, Tables<Size>& t) noexcept {
  for (int i = 0; i < scene.bodies; ++i) {
    const Body& body = scene.body[i];
    const int p = body.parent;
    t.at[i] = axes(body.at);
    t.com[i] = body.mass > 0 ? axes(body.com) : Axes{};
    t.turned[i] = body.turn.x != 1 || body.turn.y != 0;
    if (p != ground) {
      t.turning[i] = t.turning[p];
      t.known_turning[i] = t.known_turning[p];
      t.freely_turning[i] = t.freely_turning[p];
      const bool arm = t.at[i].any() || (body.joint != Joint::revolute && body.joint != Joint::fixed);
      t.moving[i] = t.moving[p] || (t.turning[p] && arm);
      t.freely_moving[i] = t.freely_moving[p] || (t.freely_turning[p] && arm);
    }
    for (int k = 0; k < coordinates(body.joint); ++k) {
      const int j = t.first[i] + k;
      const bool free = t.drive_of[j] == none;
      if (t.motion[j] == Motion::turn) {
        t.turning[i] = true;
        t.known_turning[i] = t.known_turning[i] || !free;
        t.freely_turning[i] = t.freely_turning[i] || free;
      } else {
        t.moving[i] = true;
        t.freely_moving[i] = t.freely_moving[i] || free;
      }
    }
    t.carried_mass[i] = body.mass;
    t.origin_inertia[i] = t.com[i].any() ? body.inertia + body.mass * squared(body.com) : body.inertia;
    t.arm_squared[i] = squared(body.at);
    t.off_centre[i] = t.com[i].any();
  }
  for (int i = scene.bodies - 1; i >= 0; --i) {
    const Body& body = scene.body[i];
    if (body.parent == ground) continue;
    const bool arm = t.at[i].any() || (body.joint != Joint::revolute && body.joint != Joint::fixed);
    t.carried_mass[body.parent] += t.carried_mass[i];
    t.off_centre[body.parent] = t.off_centre[body.parent] || t.off_centre[i] || (arm && t.carried_mass[i] > 0);
  }
  const auto apply = [&](int i) {
    if (i != ground) t.applied[i] = true;
  };
  for (int s = 0; s < scene.springs; ++s) {
    apply(scene.spring[s].a);
    apply(scene.spring[s].b);
  }
  for (int l = 0; l < scene.loads; ++l) apply(scene.load[l].body);
  for (int g = 0; g < scene.guides; ++g) {
    if (!t.is_steady[g]) continue;
    apply(scene.guide[g].slider);
    apply(scene.guide[g].rail);
  }
}

template <class Size>
constexpr double largest_distance(const Scene<Size>& scene) noexcept {
  double most = 0;
  const auto consider = [&](Vec2 r) { most = squared(r) > most ? squared(r) : most; };
  for (int i = 0; i < scene.bodies; ++i) {
    const Body& body = scene.body[i];
    consider(body.at);
    consider(body.com);
    if (body.joint == Joint::prismatic) consider({body.q[0], 0});
    if (body.joint == Joint::planar) consider({body.q[0], body.q[1]});
  }
  for (int g = 0; g < scene.guides; ++g) {
    consider(scene.guide[g].origin);
    for (int c = 0; c < scene.guide[g].contacts; ++c) consider(scene.guide[g].contact[c]);
  }
  for (int p = 0; p < scene.pins; ++p) {
    consider(scene.pin[p].a_at);
    consider(scene.pin[p].b_at);
  }
  return most > 0 ? rough_sqrt(most) : 1;
}

}  // namespace detail

/// The tables of a scene without defects. Quadratic in coordinates times the depth of the tree.
template <class Size>
constexpr Tables<Size> derive(const Scene<Size>& scene) noexcept {
  Tables<Size> t;
  detail::derive_coordinates(scene, t);
  detail::derive_ups(scene, t);
  detail::derive_links(scene, t);
  detail::derive_parts(scene, t);
  detail::derive_zeros(scene, t);
  t.length = detail::largest_distance(scene);
  return t;
}

// --- sources ---------------------------------------------------------------------------------------------------------

/// A scene that the compiler knows: loops over it fold, and what it does not have costs nothing.
template <const auto& scene_>
struct CompileTime {
  using Size = typename std::remove_cv_t<std::remove_reference_t<decltype(scene_)>>::Size;
  static_assert(defects(scene_).count == 0, "the scene has defects: slideway::defects(scene) lists them");
  static constexpr bool folds = true, sound = true;
  static constexpr Tables<Size> tables = derive(scene_);
  static constexpr const Scene<Size>& scene = scene_;
};

/// A scene that is known when the program runs, with room for `Size_`. One with defects is not taken: it counts as
/// empty and not sound, and every step refuses.
template <class Size_>
struct RunTime {
  using Size = Size_;
  static constexpr bool folds = false;
  bool sound;
  Scene<Size> scene;
  Tables<Size> tables;
  explicit constexpr RunTime(const Scene<Size>& data) noexcept
      : sound(defects(data).count == 0), scene(sound ? data : Scene<Size>{}), tables(derive(scene)) {}
};

/// Longest loop that is written out. Beyond it the compiler takes minutes: see docs/decisions.md.
inline constexpr int fold_limit = 20;

namespace detail {
template <class F, int... I>
SLIDEWAY_INLINE constexpr void fold_up(int count, F& f, std::integer_sequence<int, I...>) noexcept {
  ((I < count ? f(I) : void()), ...);
}
template <int Capacity, class F, int... I>
SLIDEWAY_INLINE constexpr void fold_down(int count, F& f, std::integer_sequence<int, I...>) noexcept {
  ((Capacity - 1 - I < count ? f(Capacity - 1 - I) : void()), ...);
}
}  // namespace detail

/// f(0), ..., f(count - 1); count <= Capacity. Written out for a compile-time source, a loop otherwise: the same
/// operations in the same order.
template <class Source, int Capacity, class F>
SLIDEWAY_INLINE constexpr void for_each(int count, F&& f) noexcept {
  if constexpr (Source::folds && Capacity <= fold_limit) {
    detail::fold_up(count, f, std::make_integer_sequence<int, Capacity>{});
  } else if constexpr (Capacity > 0) {
    SLIDEWAY_ASSUME(count <= Capacity);
    for (int i = 0; i < count; ++i) f(i);
  }
}

/// f(count - 1), ..., f(0).
template <class Source, int Capacity, class F>
SLIDEWAY_INLINE constexpr void for_each_down(int count, F&& f) noexcept {
  if constexpr (Source::folds && Capacity <= fold_limit) {
    detail::fold_down<Capacity>(count, f, std::make_integer_sequence<int, Capacity>{});
  } else if constexpr (Capacity > 0) {
    SLIDEWAY_ASSUME(count <= Capacity);
    for (int i = count - 1; i >= 0; --i) f(i);
  }
}

}  // namespace slideway
