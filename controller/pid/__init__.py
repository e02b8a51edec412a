"""The paper's PID controller and the tuned one."""
