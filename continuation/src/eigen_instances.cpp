#define INSTANCE_OF_EIGEN template
#include "continuation/eigen_instances.hpp"
