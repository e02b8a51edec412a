/* Saved states: copies of all that a decision depends on, and their bytes. */
#include "instance.h"

#include <stdlib.h>
#include <string.h>

static const char FORMAT[8] = "gwctrl1"; /* the first bytes of a serialised state */

Status instance_save(const Instance *self, Snapshot **saved) {
    if (*saved == NULL) *saved = malloc(sizeof **saved);
    if (*saved == NULL) return instance_error(self, "out of memory for a saved state");
    **saved = self->now;
    return STATUS_OK;
}

Status instance_restore(Instance *self, const Snapshot *saved) {
    if (saved == NULL) return instance_error(self, "no saved state to restore");
    self->now = *saved;
    return STATUS_OK;
}

size_t snapshot_size(void) { return sizeof FORMAT + sizeof(Snapshot); }

Status snapshot_serialize(const Instance *self, const Snapshot *s, void *bytes, size_t size) {
    if (s == NULL) return instance_error(self, "no saved state to serialise");
    if (size < snapshot_size()) return instance_error(self, "buffer of %zu bytes: expected %zu", size, snapshot_size());
    memcpy(bytes, FORMAT, sizeof FORMAT);
    memcpy((char *)bytes + sizeof FORMAT, s, sizeof *s);
    return STATUS_OK;
}

static bool is_one_of(int value, int choices) { return value > 0 && (value & (value - 1)) == 0 && value & choices; }

Status snapshot_deserialize(const Instance *self, const void *bytes, size_t size, Snapshot **saved) {
    Snapshot s;
    double value;
    if (bytes == NULL || size != snapshot_size())
        return instance_error(self, "serialised state of %zu bytes: expected %zu", size, snapshot_size());
    memcpy(&s, (const char *)bytes + sizeof FORMAT, sizeof s);
    const bool phase = is_one_of(s.phase, CREATED | CONFIGURING | INITIALISING | STEPPING | TERMINATED);
    const bool stage = s.stage == HELD || s.stage == OPEN || s.stage == DECIDED;
    const bool parameters = parameter_problem(&s.parameters, &value) == NULL;
    if (memcmp(bytes, FORMAT, sizeof FORMAT) != 0 || !phase || !stage || !parameters)
        return instance_error(self, "serialised state: not one of this model");
    if (*saved == NULL) *saved = malloc(sizeof **saved);
    if (*saved == NULL) return instance_error(self, "out of memory for a saved state");
    **saved = s;
    return STATUS_OK;
}
