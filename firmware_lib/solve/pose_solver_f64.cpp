// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "pose_solver_steps.hpp"

namespace picolo::inline v0 {

PICOLO_INSTANTIATE_LINE_PLANE(double);
template class PoseSolver<double>;

}  // namespace picolo::inline v0
