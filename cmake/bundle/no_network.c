/* Stands for libcurl in what is copied to other systems. Only the driver of HDF5 for files on remote servers calls it, which
 * zerocount never asks for; libcurl would bring 27 other libraries. Every function says that it failed. */
#include <stddef.h>

enum { failed_init = 2 };

int curl_global_init(long flags) {
  (void)flags;
  return failed_init;
}

void curl_global_cleanup(void) {}

void* curl_easy_init(void) {
  return NULL;
}

void curl_easy_cleanup(void* handle) {
  (void)handle;
}

int curl_easy_setopt(void* handle, int option, ...) {
  (void)handle;
  (void)option;
  return failed_init;
}

int curl_easy_perform(void* handle) {
  (void)handle;
  return failed_init;
}

void* curl_slist_append(void* list, const char* text) {
  (void)list;
  (void)text;
  return NULL;
}

void curl_slist_free_all(void* list) {
  (void)list;
}
