"""The laws of contact, a folder for each model, chosen by the type of the case's contact setting.

A law is a module `law.py` that has

MEMORY             columns of `Pairs` that this law alone writes and reads
LONG_STRIDE        steps of a stride from which on it is looked ahead at what contacts will press with where it ends; effect: fewer
                   cost time, more let a force that jumps within a stride cost energy
press              the normal part of a contact, as `Pressed`
force_change       by how much its elastic force at another pose differs from what it is now
carry              what becomes of the spring of friction when its stiffness changes
rubbed             what friction lost in a step, and what the law made by changing the spring
deepest            the overlap up to which the law means something
resting_stiffness  the stiffest contacts that bodies may rest on, for the critical time step

Their arguments are those of the functions here. The first five kernels call: the choice falls while they are compiled. All laws'
memory lies in the pair's one row (`state.pairs.COLUMNS`): it takes 6 lines of the processor's cache with the memory of any one law
and with that of both, and rows of one layout need one kind of list, of copy and of checkpoint.
"""

from dilatedem.contact.consistent import law as consistent
from dilatedem.contact.liu2015 import law as liu2015
from dilatedem.jit import by_type
from dilatedem.state.setting import CONTACT_SETTINGS

MODELS = {"liu2015": liu2015, "consistent": consistent}
LAWS = {setting: MODELS[model] for (model, _), setting in CONTACT_SETTINGS.items()}

press = by_type(liu2015.press, {setting: law.press for setting, law in LAWS.items()})
force_change = by_type(liu2015.force_change, {setting: law.force_change for setting, law in LAWS.items()})
carry = by_type(liu2015.carry, {setting: law.carry for setting, law in LAWS.items()})
rubbed = by_type(liu2015.rubbed, {setting: law.rubbed for setting, law in LAWS.items()})
deepest = by_type(liu2015.deepest, {setting: law.deepest for setting, law in LAWS.items()})


def law_of(contact):
    """The law of a contact setting, a module: for Python. Kernels call the functions above."""
    return LAWS[type(contact)]
