#pragma once

#include <complex>
#include <vector>

#include "windlass/chain/chain.hpp"

namespace windlass::stability {

/// Eigenvalues λ of K v = λ M v, K the linearisation of a dragged state on its active contacts, which is not symmetric, M the metric
/// ∫ |δ(rotation)|² ds: those nearest to zero and those of the least real part, by SLEPc on K⁻¹ M; least real part first.
/// The state is stable where all have positive real parts; a real λ through zero is a fold or branch point, a complex pair
/// through the imaginary axis flutter.
/// @param count  how many are wanted at least, if there are as many
/// @throws petsc::Error if SLEPc fails; std::runtime_error where K is singular
std::vector<std::complex<double>> leading_eigenvalues(const chain::Chain::DraggedVariation& variation,
                                                      int count);

}  // namespace windlass::stability
