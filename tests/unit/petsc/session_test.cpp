#include <petscvec.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <stdexcept>

#include "windlass/petsc/session.hpp"

using namespace windlass;

BOOST_AUTO_TEST_SUITE(petsc_session)

BOOST_AUTO_TEST_CASE(starts_lazily_with_the_users_options) {
  BOOST_TEST(!petsc::session_started());
  const std::string options[] = {"-windlass_probe", "42"};
  petsc::set_options(options);
  petsc::ensure_session();
  petsc::ensure_session();
  BOOST_TEST(petsc::session_started());
  PetscInt probe = 0;
  PetscBool found = PETSC_FALSE;
  petsc::check(PetscOptionsGetInt(nullptr, nullptr, "-windlass_probe", &probe, &found));
  BOOST_TEST(found == PETSC_TRUE);
  BOOST_TEST(probe == 42);
  BOOST_CHECK_THROW(petsc::set_options(options), std::logic_error);
}

BOOST_AUTO_TEST_CASE(a_failed_call_throws_what_petsc_said) {
  petsc::ensure_session();
  Vec vector = nullptr;
  petsc::check(VecCreate(PETSC_COMM_SELF, &vector));
  try {
    petsc::check(VecSetType(vector, "no_such_type"));
    BOOST_ERROR("the call should have failed");
  } catch (const petsc::Error& error) {
    BOOST_TEST(error.code() == PETSC_ERR_ARG_UNKNOWN_TYPE);
    BOOST_TEST(std::string(error.what()).find("no_such_type") != std::string::npos);
  }
  petsc::check(VecDestroy(&vector));
}

BOOST_AUTO_TEST_CASE(an_exception_in_a_callback_passes_through_petsc) {
  petsc::ensure_session();
  const PetscErrorCode code = petsc::guard([] { throw std::domain_error("left the domain"); });
  BOOST_TEST(code == PETSC_ERR_USER);
  BOOST_CHECK_THROW(petsc::check(code), std::domain_error);
  BOOST_CHECK_NO_THROW(petsc::check(petsc::guard([] {})));
  BOOST_CHECK_THROW(petsc::check(PETSC_ERR_USER), petsc::Error);  // the exception was kept once, not for ever
}

BOOST_AUTO_TEST_SUITE_END()
