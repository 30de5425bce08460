#define INSTANCE_OF_EIGEN template  // defines what the header, first included before this line, declares
#include "continuation/eigen_instances.hpp"
