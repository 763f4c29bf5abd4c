@@ HEAD
/* @NAME@: a @KIND@ law for Fretwork. Fill in the two functions marked (1) and (2).
 * fretwork.h documents the content and unit of every column, and when each call is made. */
#include <math.h>
#include <string.h>
#include "fretwork.h"

@@ FAIL
/* Returns an error with a message; contacts are counted from 0. */
static int32_t fail(fw_message *message, size_t contact, const char *text) {
    message->contact = (int64_t)contact;
    if (message->capacity > 0) {
        strncpy(message->text, text, message->capacity - 1);
        message->text[message->capacity - 1] = 0;
    }
    return FW_ERROR;
}

@@ TABLE
static const fw_plugin table = {
    .size = sizeof(fw_plugin),
    .abi_major = FW_ABI_MAJOR,
    .abi_minor = FW_ABI_MINOR,
    .kind = FW_KIND_@KINDUP@,
    .name = "@NAME@",
    .version = "0.1.0",
    .reference = "say where the equations come from",
    .n_parameters = sizeof parameters / sizeof *parameters,
    .parameters = parameters,
@@ END
};

const fw_plugin *fretwork_plugin(void) { return &table; }
