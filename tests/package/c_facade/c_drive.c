/* SPDX-FileCopyrightText: picolo contributors
 * SPDX-License-Identifier: Apache-2.0 */

/* A firmware in C11: 12 s of an arc in a rectangular room, fed through picolo.h. Exit 0 when the
 * pose is tracked and right. */

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picolo/picolo.h"

#define FRAME_US 5000
#define BEAMS_PER_FRAME 18
#define BEAMS 360

static const double kPi = 3.14159265358979323846;
static const double kSpeed_mps = 0.5;
static const double kTurn_radps = 0.25;
static const double kLeft_m = -3.0, kRight_m = 4.0, kLow_m = -1.5, kHigh_m = 4.5;

static picolo_storage storage;

/* Of an arc from the origin. */
static void truth_at(double t_s, double* x_m, double* y_m, double* theta_rad) {
  const double radius_m = kSpeed_mps / kTurn_radps;
  *theta_rad = kTurn_radps * t_s;
  *x_m = radius_m * sin(*theta_rad);
  *y_m = radius_m * (1.0 - cos(*theta_rad));
}

static double range_at(double x_m, double y_m, double angle_rad) {
  const double c = cos(angle_rad), s = sin(angle_rad);
  const double along_x = c > 0.0 ? (kRight_m - x_m) / c : c < 0.0 ? (kLeft_m - x_m) / c : 1e9;
  const double along_y = s > 0.0 ? (kHigh_m - y_m) / s : s < 0.0 ? (kLow_m - y_m) / s : 1e9;
  return fmin(along_x, along_y);
}

static void feed_beams(picolo_vehicle* vehicle, int64_t begin_us, int first_beam) {
  for (int k = 0; k < BEAMS_PER_FRAME; ++k) {
    const int beam = (first_beam + k) % BEAMS;
    const int64_t stamp_us = begin_us + (int64_t)k * FRAME_US / BEAMS_PER_FRAME;
    const double bearing_rad = -kPi + 2.0 * kPi * beam / BEAMS;
    double x_m, y_m, theta_rad;
    truth_at((double)stamp_us * 1e-6, &x_m, &y_m, &theta_rad);
    (void)picolo_add_beam(vehicle, stamp_us, (float)range_at(x_m, y_m, theta_rad + bearing_rad),
                          (float)bearing_rad, beam == 0);
  }
}

static void feed_wheels(picolo_vehicle* vehicle, const picolo_config* config, int64_t stamp_us) {
  const double t_s = (double)stamp_us * 1e-6;
  const double left_m = (kSpeed_mps - 0.5 * kTurn_radps * config->track_m) * t_s;
  const double right_m = (kSpeed_mps + 0.5 * kTurn_radps * config->track_m) * t_s;
  const double per_rad = config->counts_per_revolution / (2.0 * kPi);
  (void)picolo_add_wheels(vehicle, stamp_us, (int64_t)(left_m / config->left_radius_m * per_rad),
                          (int64_t)(right_m / config->right_radius_m * per_rad));
}

static int fail(const char* what) {
  fprintf(stderr, "c_drive: %s\n", what);
  return 1;
}

int main(void) {
  picolo_config config;
  picolo_default_config(&config);
  picolo_config nonsense = config;
  nonsense.track_m = -1.0;
  if (picolo_create(&storage, &nonsense) != NULL) { return fail("took a negative track"); }

  picolo_vehicle* const vehicle = picolo_create(&storage, &config);
  if (vehicle == NULL) { return fail("refused its own defaults"); }
  picolo_pose pose;
  if (picolo_read_pose(vehicle, &pose)) { return fail("a pose before the start"); }
  if (picolo_start(vehicle, 0) != PICOLO_OK) { return fail("did not start"); }
  const float acceleration_mps2[3] = {0.0F, 0.0F, 9.81F};
  const float rate_radps[3] = {0.0F, 0.0F, (float)kTurn_radps};
  int first_beam = 0;
  for (int64_t now_us = 0; now_us < 12000000; now_us += FRAME_US) {
    if (now_us > 0) {
      feed_beams(vehicle, now_us - FRAME_US, first_beam);
      first_beam = (first_beam + BEAMS_PER_FRAME) % BEAMS;
    }
    if (now_us % (2 * FRAME_US) == 0) { feed_wheels(vehicle, &config, now_us); }
    (void)picolo_add_imu(vehicle, now_us, acceleration_mps2, rate_radps);
    if (picolo_next_frame_us(vehicle) != now_us) { return fail("frames are not 5 ms apart"); }
    if (picolo_run_frame(vehicle, now_us) != PICOLO_OK) { return fail("a frame did not run"); }
    if (picolo_run_frame(vehicle, now_us) != PICOLO_NOT_READY) { return fail("a frame ran twice"); }
  }
  if (!picolo_read_pose(vehicle, &pose)) { return fail("no pose"); }
  double x_m, y_m, theta_rad;
  truth_at((double)pose.stamp_us * 1e-6, &x_m, &y_m, &theta_rad);
  const double error_m = hypot(pose.x_m - x_m, pose.y_m - y_m);
  printf("picolo %u: %s (%s), %u matches, error %.4f m, %u samples lost\n", picolo_version(),
         picolo_health_name(pose.health), picolo_reason_name(pose.reason), pose.matches, error_m,
         picolo_lost_samples(vehicle));
  if (pose.health != PICOLO_TRACKING) { return fail("not tracking"); }
  if (error_m > 0.05 || pose.matches < 60) { return fail("the pose is wrong"); }
  if (pose.covariance[0] <= 0.0F || pose.covariance[1] != pose.covariance[3]) {
    return fail("no covariance");
  }
  if (fabsf(pose.speed_mps - (float)kSpeed_mps) > 0.02F) { return fail("wrong speed"); }
  if (picolo_lost_samples(vehicle) != 0) { return fail("samples were lost"); }
  for (int k = 0; k < 20; ++k) { (void)picolo_add_imu(vehicle, 0, acceleration_mps2, rate_radps); }
  if (picolo_lost_samples(vehicle) != 4) { return fail("lost samples are not counted"); }
  if (strcmp(picolo_health_name(PICOLO_LOST), "lost") != 0) { return fail("wrong name"); }
  const uint32_t version =
      PICOLO_VERSION_MAJOR * 10000 + PICOLO_VERSION_MINOR * 100 + PICOLO_VERSION_PATCH;
  if (picolo_version() != version) { return fail("header and library disagree"); }
  return 0;
}
