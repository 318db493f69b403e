/* SPDX-FileCopyrightText: picolo contributors
 * SPDX-License-Identifier: Apache-2.0 */
/** @file
 * picolo for firmware in C: the installed controller (profile room) fed with samples of any
 * devices.
 *
 *   static picolo_storage storage;
 *   picolo_config config;
 *   picolo_default_config(&config);
 *   picolo_vehicle* vehicle = picolo_create(&storage, &config);
 *   picolo_start(vehicle, now_us());
 *   for (;;) {
 *     sleep_until(picolo_next_frame_us(vehicle));
 *     picolo_run_frame(vehicle, now_us());
 *   }
 *
 * No heap, no blocking. Times are microseconds of one monotonic clock. Base: x forward, y left, the
 * middle of the axle. All functions belong to the cycle's context but for picolo_read_pose (any)
 * and the picolo_add_ functions: each may have one context of its own, an interrupt for example. */
#ifndef PICOLO_PICOLO_H
#define PICOLO_PICOLO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "picolo/core/version.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Of one vehicle; the library checks at compile time that it is enough. */
#define PICOLO_STORAGE_BYTES 212992

/** Memory of a vehicle, static in general. Alignment of uint64_t is enough. */
typedef struct picolo_storage {
  uint64_t words[PICOLO_STORAGE_BYTES / 8];
} picolo_storage;

/** Lives in a picolo_storage. */
typedef struct picolo_vehicle picolo_vehicle;

/** As picolo::Status. */
typedef enum picolo_status {
  PICOLO_OK = 0,
  PICOLO_NOT_READY = 1,
  PICOLO_FULL = 2,
  PICOLO_INVALID_ARGUMENT = 3
} picolo_status;

/** As picolo::HealthState: how far the pose may be trusted. */
typedef enum picolo_health {
  PICOLO_INITIALISING = 0,
  PICOLO_TRACKING = 1,
  PICOLO_DEGRADED = 2,
  PICOLO_LOST = 3,
  PICOLO_FAULT = 4,
  PICOLO_RELOCALISING = 5
} picolo_health;

typedef struct picolo_config {
  double left_radius_m;
  double right_radius_m;
  double track_m;               /**< distance of the wheels' contact points */
  double counts_per_revolution; /**< of a wheel, gear included */
  float lidar_x_m;              /**< of the lidar on the vehicle */
  float lidar_y_m;
  float lidar_yaw_rad;
  float lidar_min_m; /**< what is nearer or farther is no measurement */
  float lidar_max_m;
  double start_x_m; /**< of the vehicle in the map at the start */
  double start_y_m;
  double start_theta_rad;
  bool has_gyro; /**< false: picolo_add_imu is never called */
} picolo_config;

typedef struct picolo_pose {
  int64_t stamp_us; /**< the instant of the pose */
  double x_m;       /**< in the map; jumps when a match corrects it */
  double y_m;
  double theta_rad;
  double odom_x_m; /**< in the odometry's frame; continuous, drifts */
  double odom_y_m;
  double odom_theta_rad;
  float speed_mps;
  float yaw_rate_radps;
  float covariance[9];       /**< of (x, y, theta) given the map, row by row */
  float drift_covariance[9]; /**< of the map against the start */
  int64_t match_age_us;      /**< since the last accepted match */
  uint32_t matches;          /**< accepted so far */
  uint8_t health;            /**< picolo_health */
  uint8_t reason;            /**< why; picolo_reason_name tells */
} picolo_pose;

/** A differential drive with 0.1 m wheels 0.5 m apart, lidar in its middle, gyro. */
void picolo_default_config(picolo_config* config);

/** Builds a vehicle in the storage, which outlives it. NULL: the configuration is not valid. */
picolo_vehicle* picolo_create(picolo_storage* storage, const picolo_config* config);

/** The first frame is due at once. */
picolo_status picolo_start(picolo_vehicle* vehicle, int64_t now_us);
/** When the next frame of 5 ms is due. */
int64_t picolo_next_frame_us(const picolo_vehicle* vehicle);
/** Runs the tasks of the frame that is due. PICOLO_NOT_READY: none is. Bounded work. */
picolo_status picolo_run_frame(picolo_vehicle* vehicle, int64_t now_us);

/** Samples in the order of their stamps, before the frame that should see them. PICOLO_FULL: more
 * than the queue holds (16 wheel, 256 beam, 16 IMU samples); the sample is lost and counted. */
picolo_status picolo_add_wheels(picolo_vehicle* vehicle, int64_t stamp_us, int64_t left_counts,
                                int64_t right_counts);
/** A beam of the lidar in its own frame; `range_m` 0 when nothing came back, bearing
 * counter-clockwise from its x axis, `starts_sweep` with the first of a revolution. */
picolo_status picolo_add_beam(picolo_vehicle* vehicle, int64_t stamp_us, float range_m,
                              float bearing_rad, bool starts_sweep);
/** Specific force and rate, x forward, y left, z up. */
picolo_status picolo_add_imu(picolo_vehicle* vehicle, int64_t stamp_us,
                             const float acceleration_mps2[3], const float rate_radps[3]);
/** Samples that found their queue full, ever. */
uint32_t picolo_lost_samples(const picolo_vehicle* vehicle);

/** The newest pose. False before the start. Wait-free. */
bool picolo_read_pose(const picolo_vehicle* vehicle, picolo_pose* pose);

/** Names for logs. */
const char* picolo_health_name(uint8_t health);
const char* picolo_reason_name(uint8_t reason);
/** The version that was linked: major * 10000 + minor * 100 + patch. */
uint32_t picolo_version(void);

#ifdef __cplusplus
}
#endif

#endif
