// The counter that other tests rely on counts.
#include "support/allocations.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace {

/// Allocations of one call, which may return memory to be freed. Through a volatile pointer, so that no compiler can
/// leave the allocation out.
template <class Call>
std::size_t count(Call call) {
  const std::size_t before = slideway::test::allocations();
  void* volatile memory = call();
  const std::size_t after = slideway::test::allocations();
  std::free(memory);
  return after - before;
}

TEST(Allocations, EveryWayToTheHeapIsCounted) {
  if (!slideway::test::allocations_are_counted()) GTEST_SKIP() << "not counted: not glibc, or a sanitizer's malloc";
  void* none = nullptr;
  EXPECT_EQ(count([&] { return none; }), 0u);
  EXPECT_EQ(count([] { return std::malloc(8); }), 1u);
  EXPECT_EQ(count([] { return std::calloc(2, 8); }), 1u);
  EXPECT_EQ(count([&] { return std::realloc(none, 8); }), 1u);
  EXPECT_EQ(count([] { return std::aligned_alloc(64, 64); }), 1u);
  EXPECT_EQ(count([&] { return posix_memalign(&none, 64, 64) == 0 ? none : nullptr; }), 1u);
  EXPECT_EQ(count([] { return ::operator new(8); }), 1u);
  EXPECT_EQ(count([] { return ::operator new (64, std::align_val_t{64}); }), 1u);
}

TEST(Allocations, ContainersAreCounted) {
  if (!slideway::test::allocations_are_counted()) GTEST_SKIP() << "not counted: not glibc, or a sanitizer's malloc";
  volatile Eigen::Index size = 20;
  const std::size_t before = slideway::test::allocations();
  const Eigen::VectorXd matrix = Eigen::VectorXd::Constant(size, 1.0);
  const std::vector<double> vector(static_cast<std::size_t>(size), 1.0);
  EXPECT_EQ(slideway::test::allocations() - before, 2u);
  EXPECT_EQ(matrix[19], vector[19]);
}

}  // namespace
