// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "pose_solver_steps.hpp"

namespace picolo::inline v0 {

PICOLO_INSTANTIATE_LINE_PLANE(float);
template class PoseSolver<float>;

}  // namespace picolo::inline v0
