// Truncated Taylor series in time, extended order by order: the arithmetic of the oracle's trajectories.
//
// A Tape records a computation once. Coefficient k of every recorded quantity then follows from coefficients <= k of
// its operands (Moore, Interval Analysis, 1966, ch. 11), O(k) for a product. Quantities that depend on positions alone
// are kept one order ahead of those that depend on speeds: an equation of motion that gives q'' to order k needs the
// constraint Jacobian to order k + 1, for its rate.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace slideway::oracle {

template <class T>
class Tape {
  enum class Kind { variable, sum, shift, scale, product, reciprocal, root, rate, sine, cosine };

 public:
  /// A quantity: a constant, or an entry of a tape.
  class Node {
   public:
    Node() : value_(0) {}
    Node(const T& constant) : value_(constant) {}
    bool is_constant() const { return tape_ == nullptr; }
    bool is_zero() const { return is_constant() && value_ == 0; }
    /// Coefficient k; valid once the tape has been extended that far.
    const T& operator[](int k) const {
      static const T zero(0);
      return is_constant() ? (k == 0 ? value_ : zero) : tape_->coefficient(op_, k);
    }

    friend Node operator+(const Node& a, const Node& b) {
      if (a.is_constant() && b.is_constant()) return Node(T(a.value_ + b.value_));
      if (a.is_zero()) return b;
      if (b.is_zero()) return a;
      if (a.is_constant()) return record(b.tape_, Kind::shift, b, {}, a.value_);
      if (b.is_constant()) return record(a.tape_, Kind::shift, a, {}, b.value_);
      return record(a.tape_, Kind::sum, a, b);
    }
    friend Node operator-(const Node& a) { return T(-1) * a; }
    friend Node operator-(const Node& a, const Node& b) { return a + -b; }
    friend Node operator*(const T& factor, const Node& a) { return Node(factor) * a; }
    friend Node operator*(const Node& a, const Node& b) {
      if (a.is_constant() && b.is_constant()) return Node(T(a.value_ * b.value_));
      if (a.is_zero() || b.is_zero()) return Node();
      if (!a.is_constant() && !b.is_constant()) return record(a.tape_, Kind::product, a, b);
      const Node& series = a.is_constant() ? b : a;
      const T& factor = a.is_constant() ? a.value_ : b.value_;
      return factor == 1 ? series : record(series.tape_, Kind::scale, series, {}, factor);
    }
    /// Of a quantity that is not constant.
    friend Node reciprocal(const Node& a) { return record(a.tape_, Kind::reciprocal, a); }
    friend Node root(const Node& a) { return record(a.tape_, Kind::root, a); }
    /// The rate of a quantity that depends on positions alone.
    friend Node rate(const Node& a) { return a.is_constant() ? Node() : record(a.tape_, Kind::rate, a); }

   private:
    friend class Tape;
    using Kind = typename Tape::Kind;
    static Node record(Tape* tape, Kind kind, const Node& a, const Node& b = {}, const T& constant = T(0)) {
      return tape->record(kind, a, b, constant);
    }
    Node(Tape* tape, int op) : value_(0), tape_(tape), op_(op) {}
    T value_;
    Tape* tape_ = nullptr;
    int op_ = -1;
  };

  struct Turn {
    Node cosine, sine;
  };

  /// Coefficients 0 .. orders - 1.
  explicit Tape(int orders) : orders_(orders) {}
  Tape(const Tape&) = delete;
  Tape& operator=(const Tape&) = delete;

  int orders() const { return orders_; }

  /// A quantity that set() gives the coefficients of: a position, or a function of time.
  Node variable() { return record(Kind::variable, {}); }
  Turn turn(const Node& angle) {
    const Node sine = record(Kind::sine, angle), cosine = record(Kind::cosine, angle);
    return {cosine, sine};
  }
  void set(const Node& variable, int k, const T& value) { at(variable.op_, k) = value; }

  /// Positions are known to order k + 1: extends what depends on them to k + 1, what depends on speeds to k. Called
  /// for k = 0, 1, 2, ...
  void extend(int k) {
    if (k == 0) {
      for (int op = 0; op < count(); ++op) {
        if (!ops_[static_cast<std::size_t>(op)].of_speeds) find(op, 0);
      }
    }
    for (int op = 0; op < count(); ++op) {
      const int order = ops_[static_cast<std::size_t>(op)].of_speeds ? k : k + 1;
      if (order < orders_) find(op, order);
    }
  }

 private:
  struct Op {
    Kind kind;
    int a, b;
    T constant;
    bool of_speeds;
  };

  int count() const { return static_cast<int>(ops_.size()); }
  T& at(int op, int k) { return coefficients_[static_cast<std::size_t>(op * orders_ + k)]; }
  const T& coefficient(int op, int k) const { return coefficients_[static_cast<std::size_t>(op * orders_ + k)]; }

  Node record(Kind kind, const Node& a, const Node& b = {}, const T& constant = T(0)) {
    const auto of_speeds = [&](int op) { return op >= 0 && ops_[static_cast<std::size_t>(op)].of_speeds; };
    ops_.push_back({kind, a.op_, b.op_, constant, kind == Kind::rate || of_speeds(a.op_) || of_speeds(b.op_)});
    coefficients_.resize(ops_.size() * static_cast<std::size_t>(orders_));
    return Node(this, static_cast<int>(ops_.size()) - 1);
  }

  /// sum over j = from .. to of a_j b_(k-j)
  T convolution(int a, int b, int k, int from, int to) const {
    T sum(0);
    for (int j = from; j <= to; ++j) sum += coefficient(a, j) * coefficient(b, k - j);
    return sum;
  }

  /// sum over j = 1 .. k of j a_j b_(k-j), over k: how sine and cosine integrate.
  T turned(int angle, int b, int k) const {
    T sum(0);
    for (int j = 1; j <= k; ++j) sum += T(j) * coefficient(angle, j) * coefficient(b, k - j);
    return sum / T(k);
  }

  void find(int op, int k) {
    using std::cos, std::sin, std::sqrt;
    const Op& o = ops_[static_cast<std::size_t>(op)];
    switch (o.kind) {
      case Kind::variable:
        return;
      case Kind::sum:
        at(op, k) = coefficient(o.a, k) + coefficient(o.b, k);
        return;
      case Kind::shift:
        at(op, k) = k == 0 ? T(coefficient(o.a, 0) + o.constant) : coefficient(o.a, k);
        return;
      case Kind::scale:
        at(op, k) = o.constant * coefficient(o.a, k);
        return;
      case Kind::product:
        at(op, k) = convolution(o.a, o.b, k, 0, k);
        return;
      case Kind::reciprocal:  // r a = 1
        at(op, k) = k == 0 ? T(1 / coefficient(o.a, 0)) : T(-convolution(o.a, op, k, 1, k) * coefficient(op, 0));
        return;
      case Kind::root:  // r r = a
        at(op, k) = k == 0 ? T(sqrt(coefficient(o.a, 0)))
                           : T((coefficient(o.a, k) - convolution(op, op, k, 1, k - 1)) / (2 * coefficient(op, 0)));
        return;
      case Kind::rate:
        if (k + 1 < orders_) at(op, k) = T(k + 1) * coefficient(o.a, k + 1);
        return;
      case Kind::sine:  // recorded just before its cosine
        at(op, k) = k == 0 ? T(sin(coefficient(o.a, 0))) : turned(o.a, op + 1, k);
        return;
      case Kind::cosine:
        at(op, k) = k == 0 ? T(cos(coefficient(o.a, 0))) : T(-turned(o.a, op - 1, k));
        return;
    }
  }

  int orders_;
  std::vector<Op> ops_;
  std::vector<T> coefficients_;
};

}  // namespace slideway::oracle
