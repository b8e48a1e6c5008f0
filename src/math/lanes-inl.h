// SPDX-License-Identifier: Apache-2.0
// Arithmetic of vectors with numbers, which stand for vectors of equal lanes.
#pragma once

#include <hwy/highway.h>

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace orrery::math::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A Highway vector.
template <class V>
concept Vector = std::is_class_v<V> && requires {
  typename hn::TFromV<V>;
};

/// A number, or an enumerator that is compared with stored ones.
template <class S>
concept Number = std::is_arithmetic_v<S> || std::is_enum_v<S>;

/// A number in all lanes, rounded to the lanes' type.
template <class D, Number S>
HWY_INLINE hn::Vec<D> set(D d, S s) {
  return hn::Set(d, static_cast<hn::TFromD<D>>(s));
}
/// An operand as a vector of this type.
template <Vector V, Number S>
HWY_INLINE V as(S s) {
  return set(hn::DFromV<V>(), s);
}
template <Vector V>
HWY_INLINE V as(V v) {
  return v;
}

template <Vector V>
HWY_INLINE V operator-(const V& v) {
  return hn::Neg(v);
}

#define ORRERY_LANES_OPERATOR(op)                \
  template <Vector V, Number S>                  \
  HWY_INLINE auto operator op(const V& v, S s) { \
    return v op as<V>(s);                        \
  }                                              \
  template <Vector V, Number S>                  \
  HWY_INLINE auto operator op(S s, const V& v) { \
    return as<V>(s) op v;                        \
  }
ORRERY_LANES_OPERATOR(+)
ORRERY_LANES_OPERATOR(-)
ORRERY_LANES_OPERATOR(*)
ORRERY_LANES_OPERATOR(/)
ORRERY_LANES_OPERATOR(<)
ORRERY_LANES_OPERATOR(>)
ORRERY_LANES_OPERATOR(<=)
ORRERY_LANES_OPERATOR(>=)
ORRERY_LANES_OPERATOR(==)
ORRERY_LANES_OPERATOR(!=)
#undef ORRERY_LANES_OPERATOR

/// The vector type among operands of which some are numbers.
template <class A, class... Rest>
struct VectorAmong : VectorAmong<Rest...> {};
template <Vector V, class... Rest>
struct VectorAmong<V, Rest...> {
  using Type = V;
};
template <class... Operands>
using VectorOf = typename VectorAmong<Operands...>::Type;
template <class A>
concept Operand = Vector<A> || Number<A>;

template <Operand A, Operand B>
HWY_INLINE auto max(A a, B b) {
  using V = VectorOf<A, B>;
  return hn::Max(as<V>(a), as<V>(b));
}
template <Operand A, Operand B>
HWY_INLINE auto min(A a, B b) {
  using V = VectorOf<A, B>;
  return hn::Min(as<V>(a), as<V>(b));
}
/// Returns a b + c, rounded once, except without fused multiply-add (SSE4).
template <Operand A, Operand B, Operand C>
HWY_INLINE auto mul_add(A a, B b, C c) {
  using V = VectorOf<A, B, C>;
  return hn::MulAdd(as<V>(a), as<V>(b), as<V>(c));
}
/// Returns c - a b; rounded as by mul_add().
template <Operand A, Operand B, Operand C>
HWY_INLINE auto neg_mul_add(A a, B b, C c) {
  using V = VectorOf<A, B, C>;
  return hn::NegMulAdd(as<V>(a), as<V>(b), as<V>(c));
}
template <class M, Operand A, Operand B>
HWY_INLINE auto select(M mask, A yes, B no) {
  using V = VectorOf<A, B>;
  return hn::IfThenElse(mask, as<V>(yes), as<V>(no));
}

}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
