/* Calls the function of a component of LinuxCNC on inputs from standard input, one sample a line: target, reference, count.
 * Prints the wanted torque of each. Stands in for the HAL, of which a component needs little. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal.h"

static struct {
  char name[64];
  double number;
  volatile int bit;
} pins[16];
static int pin_count;
static void (*function)(void*, long);
static void* instance;

static int new_pin(const char* format, va_list names) {
  vsnprintf(pins[pin_count].name, sizeof pins[pin_count].name, format, names);
  return pin_count++;
}
static double* pin(const char* name) {
  for (int i = 0; i < pin_count; ++i)
    if (strstr(pins[i].name, name) != NULL) return &pins[i].number;
  exit(1);
}

int hal_init(const char* name) { return name != NULL; }
int hal_exit(int id) { return id * 0; }
int hal_ready(int id) { return id * 0; }
void* hal_malloc(long size) { return malloc((size_t)size); }
int hal_pin_bit_newf(hal_pin_dir_t direction, hal_bit_t** at, int id, const char* format, ...) {
  va_list names;
  (void)direction, (void)id;
  va_start(names, format);
  *at = (hal_bit_t*)&pins[new_pin(format, names)].bit;
  **at = 1;
  va_end(names);
  return 0;
}
int hal_pin_float_newf(hal_pin_dir_t direction, hal_float_t** at, int id, const char* format, ...) {
  va_list names;
  (void)direction, (void)id;
  va_start(names, format);
  *at = (hal_float_t*)&pins[new_pin(format, names)].number;
  va_end(names);
  return 0;
}
int hal_export_funct(const char* name, void (*funct)(void*, long), void* arg, int uses_fp, int reentrant, int id) {
  (void)name, (void)uses_fp, (void)reentrant, (void)id;
  function = funct;
  instance = arg;
  return 0;
}
void rtapi_print_msg(msg_level_t level, const char* format, ...) { (void)level, (void)format; }
int rtapi_snprintf(char* to, unsigned long size, const char* format, ...) {
  va_list values;
  va_start(values, format);
  const int length = vsnprintf(to, size, format, values);
  va_end(values);
  return length;
}

int rtapi_app_main(void);

int main(void) {
  double target, reference, count;
  if (rtapi_app_main() != 0 || function == NULL) return 1;
  while (scanf("%lf %lf %lf", &target, &reference, &count) == 3) {
    *pin("target-counts") = target;
    *pin("command-counts") = reference;
    *pin("feedback-counts") = count;
    function(instance, 500000);
    printf("%.17g\n", *pin("output-torque"));
  }
  return 0;
}
