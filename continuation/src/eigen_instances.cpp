#define INSTANCE_OF_EIGEN template  // declared by the precompiled header, defined here
#include "continuation/eigen_instances.hpp"

#define INSTANCE_OF_EIGEN_SPARSE template
#include "continuation/eigen_sparse_instances.hpp"
