#include "windlass/petsc/handles.hpp"

#include <boost/test/unit_test.hpp>
#include <type_traits>

using namespace windlass;
using petsc::check;

// Runs after the session's own tests, one of which wants PETSc not yet started.
BOOST_AUTO_TEST_SUITE(petsc_handles, *boost::unit_test::depends_on("petsc_session"))

namespace {

PetscInt references(Vec vector) {
  PetscInt count = 0;
  check(PetscObjectGetReference(reinterpret_cast<PetscObject>(vector), &count));
  return count;
}

Eigen::SparseMatrix<double> saddle() {
  Eigen::Matrix3d dense;
  dense << 4.0, -1.0, 2.0, -1.0, 3.0, 0.5, 2.0, 0.5, 0.0;
  return dense.sparseView();
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_handle_starts_null_and_is_move_only) {
  petsc::VecHandle handle;
  BOOST_TEST(!handle);
  BOOST_TEST(handle.get() == nullptr);
  static_assert(!std::is_copy_constructible_v<petsc::VecHandle>);
  static_assert(std::is_nothrow_move_constructible_v<petsc::VecHandle>);
}

BOOST_AUTO_TEST_CASE(moving_leaves_null_and_keeps_one_owner) {
  petsc::VecHandle first = petsc::zero_vector(3);
  const Vec raw = first;
  petsc::VecHandle second = std::move(first);
  BOOST_TEST(!first);
  BOOST_TEST(second.get() == raw);
  second = std::move(second);
  BOOST_TEST(second.get() == raw);
  petsc::VecHandle third = petsc::zero_vector(2);
  third = std::move(second);
  BOOST_TEST(third.get() == raw);
  BOOST_TEST(references(third) == 1);
}

BOOST_AUTO_TEST_CASE(destruction_gives_back_one_reference) {
  petsc::VecHandle kept = petsc::zero_vector(3);
  check(PetscObjectReference(reinterpret_cast<PetscObject>(kept.get())));
  {
    petsc::VecHandle shared(kept.get());
    BOOST_TEST(references(kept) == 2);
  }
  BOOST_TEST(references(kept) == 1);
  Vec released = kept.release();
  BOOST_TEST(!kept);
  check(VecDestroy(&released));
}

BOOST_AUTO_TEST_CASE(put_destroys_what_was_held) {
  petsc::VecHandle kept = petsc::zero_vector(3);
  check(PetscObjectReference(reinterpret_cast<PetscObject>(kept.get())));
  petsc::VecHandle shared(kept.get());
  check(VecCreateSeq(PETSC_COMM_SELF, 5, shared.put()));
  BOOST_TEST(references(kept) == 1);
  BOOST_TEST(shared.get() != kept.get());
}

BOOST_AUTO_TEST_CASE(sparse_matrices_keep_their_action) {
  const Eigen::SparseMatrix<double> matrix = saddle();
  const Eigen::VectorXd v = Eigen::Vector3d(1.0, -2.0, 0.5);
  petsc::VecHandle x = petsc::zero_vector(3), y = petsc::zero_vector(3);
  petsc::copy(v, x);
  for (const petsc::MatHandle& mat : {petsc::aij(matrix), petsc::symmetric(matrix)}) {
    Eigen::VectorXd product;
    check(MatMult(mat, x, y));
    petsc::copy(y, product);
    BOOST_TEST((product - matrix * v).norm() < 1e-15);
  }
}

BOOST_AUTO_TEST_SUITE_END()
